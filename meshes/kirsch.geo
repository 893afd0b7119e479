// A quarter of a slab with a circular hole of radius 0.1 m yet to be dug, out to 0.4 m, one element thick.
// Regions rock, core (what is dug out); surfaces wall (between them), west (x = 0), south (y = 0), faces (z); lines o0, o1, ...
// on the outside, a pair of nodes each, from x = 0.4, y = 0 on, counter-clockwise.      gmsh -3 kirsch.geo
DefineConstant[ n = 8 ];                      // cells in 45 degrees; the outside has 2n + 1 lines
Mesh.MshFileVersion = 2.2; Mesh.Binary = 1;
a = 0.1; outer = 0.4; c = 0.5*a;              // c: edge of the square in the middle of the core
m = Round(Log(outer/a)/Log(1 + Pi/4/n));      // cells from wall to outside, about square
q = Exp(Log(outer/a)/m);                      // each so many times as long as the one before
w = Round(n/2);                               // cells from the square to the wall
thick = outer*Pi/4/n;

centre = newp; Point(centre) = {0, 0, 0};
For i In {0:2*n}                              // spokes, at equal angles
  t = i*Pi/4/n;
  e[i] = newp; Point(e[i]) = {a*Cos(t), a*Sin(t), 0};
  f[i] = newp; Point(f[i]) = {outer*Cos(t), outer*Sin(t), 0};
  spoke[i] = newl; Line(spoke[i]) = {e[i], f[i]};
  Transfinite Curve {spoke[i]} = m + 1 Using Progression q;
EndFor
For i In {0:2*n-1}
  inner[i] = newl; Circle(inner[i]) = {e[i], centre, e[i+1]};
  rim[i] = newl; Circle(rim[i]) = {f[i], centre, f[i+1]};
  Transfinite Curve {inner[i], rim[i]} = 2;
  loop = newl; Curve Loop(loop) = {spoke[i], rim[i], -spoke[i+1], -inner[i]};
  sector[i] = news; Plane Surface(sector[i]) = {loop};
  Transfinite Surface {sector[i]} = {e[i], f[i], f[i+1], e[i+1]};
EndFor
b1 = newp; Point(b1) = {c, 0, 0}; b2 = newp; Point(b2) = {c, c, 0}; b3 = newp; Point(b3) = {0, c, 0};
s1 = newl; Line(s1) = {centre, b1}; s2 = newl; Line(s2) = {b1, b2};
s3 = newl; Line(s3) = {b2, b3}; s4 = newl; Line(s4) = {b3, centre};
l1 = newl; Line(l1) = {b1, e[0]}; l2 = newl; Line(l2) = {b2, e[n]}; l3 = newl; Line(l3) = {b3, e[2*n]};
Transfinite Curve {s1, s2, s3, s4} = n + 1;
Transfinite Curve {l1, l2, l3} = w + 1;
loop = newl; Curve Loop(loop) = {s1, s2, s3, s4};
core[0] = news; Plane Surface(core[0]) = {loop};
Transfinite Surface {core[0]} = {centre, b1, b2, b3};
lower[] = {}; upper[] = {};
For i In {0:n-1}
  lower[] += inner[i]; upper[] += inner[n + i];
EndFor
loop = newl; Curve Loop(loop) = {l1, lower[], -l2, -s2};
core[1] = news; Plane Surface(core[1]) = {loop};
Transfinite Surface {core[1]} = {b1, e[0], e[n], b2};
loop = newl; Curve Loop(loop) = {l2, upper[], -l3, -s3};
core[2] = news; Plane Surface(core[2]) = {loop};
Transfinite Surface {core[2]} = {b2, e[n], e[2*n], b3};
Recombine Surface {sector[], core[]};

front[] = {sector[], core[]}; back[] = {}; wall[] = {}; rock[] = {}; dug[] = {};
For i In {0:2*n-1}
  made[] = Extrude {0, 0, thick} { Surface{sector[i]}; Layers{1}; Recombine; };
  back[] += made[0]; rock[] += made[1]; wall[] += made[5];
EndFor
For i In {0:2}
  made[] = Extrude {0, 0, thick} { Surface{core[i]}; Layers{1}; Recombine; };
  back[] += made[0]; dug[] += made[1];
EndFor
d = 1e-6;
south() = Surface In BoundingBox {-d, -d, -d, outer + d, d, thick + d};
west() = Surface In BoundingBox {-d, -d, -d, d, outer + d, thick + d};
Physical Volume("rock", 1) = {rock[]};
Physical Volume("core", 2) = {dug[]};
Physical Surface("wall", 3) = {wall[]};
Physical Surface("west", 4) = {west()};
Physical Surface("south", 5) = {south()};
Physical Surface("faces", 6) = {front[], back[]};
For i In {0:2*n}
  t = i*Pi/4/n; x = outer*Cos(t); y = outer*Sin(t);
  line() = Curve In BoundingBox {x - d, y - d, -d, x + d, y + d, thick + d};
  Physical Curve(Sprintf("o%g", i), 100 + i) = {line()};
EndFor
