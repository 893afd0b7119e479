// A mine pillar, 4 x 4 x 5.2 m, between slabs of floor and roof. Its blocks are wedges: equilateral triangles of
// side 0.5 m drawn along y, so that joints dip 0, +60 and -60 degrees; slabs are hexahedra.
// Regions floor, pillar, roof; surfaces bottom, top.   gmsh -3 pillar.geo
Mesh.MshFileVersion = 4.1; Mesh.Binary = 1;

n = 8; a = 0.5; rows = 12; layers = 4; depth = 4; slab = 1;   // triangles along x, side, rows, blocks along y
h = a*Sqrt(3)/2; height = rows*h; w = n + 3;                  // w: room for the points of a row

For r In {0:rows}                             // even rows: 0, a, 2a ...; odd rows: 0, a/2, 3a/2 ... n a
  odd = r % 2;
  For i In {0:n+odd}
    x = i*a;
    If (odd)
      x = (i == 0) ? 0 : ((i > n) ? n*a : (i - 0.5)*a);
    EndIf
    Point(1 + i + w*r) = {x, 0, r*h};
  EndFor
EndFor
below = 1 + w*(rows + 1); above = below + w;  // outer points of the slabs
For i In {0:n}
  Point(below + i) = {i*a, 0, -slab};
  Point(above + i) = {i*a, 0, height + slab};
EndFor

along = 1; left = along + w*(rows + 4); right = left + w*(rows + 4);
For r In {0:rows}                             // along a row
  For i In {0:n-1+(r % 2)}
    Line(along + i + w*r) = {1 + i + w*r, 2 + i + w*r};
  EndFor
EndFor
For r In {0:rows-1}                           // E_i to O_i and to O_(i+1), E the even row, O the odd one
  e = (r % 2) ? r + 1 : r; o = (r % 2) ? r : r + 1;
  For i In {0:n}
    Line(left + i + w*r) = {1 + i + w*e, 1 + i + w*o};
    Line(right + i + w*r) = {1 + i + w*e, 2 + i + w*o};
  EndFor
EndFor
For i In {0:n}
  Line(left + i + w*rows) = {below + i, 1 + i};
  Line(left + i + w*(rows + 1)) = {1 + i + w*rows, above + i};
EndFor
For i In {0:n-1}
  Line(along + i + w*(rows + 1)) = {below + i, below + i + 1};
  Line(along + i + w*(rows + 2)) = {above + i, above + i + 1};
EndFor
Transfinite Curve {:} = 2;

s = 0; pillar[] = {}; floor[] = {}; roof[] = {};
For r In {0:rows-1}
  e = (r % 2) ? r + 1 : r; o = (r % 2) ? r : r + 1;
  For i In {1:n}                              // on the side of the even row
    s = s + 1;
    Curve Loop(s) = {along + i - 1 + w*e, left + i + w*r, -(right + i - 1 + w*r)};
    Plane Surface(s) = {s}; pillar[] += s;
  EndFor
  For i In {0:n}                              // on the side of the odd row
    s = s + 1;
    Curve Loop(s) = {along + i + w*o, -(right + i + w*r), left + i + w*r};
    Plane Surface(s) = {s}; pillar[] += s;
  EndFor
EndFor
For i In {0:n-1}
  s = s + 1;
  Curve Loop(s) = {along + i + w*(rows + 1), left + i + 1 + w*rows, -(along + i), -(left + i + w*rows)};
  Plane Surface(s) = {s}; floor[] += s;
  s = s + 1;
  Curve Loop(s) = {along + i + w*rows, left + i + 1 + w*(rows + 1), -(along + i + w*(rows + 2)), -(left + i + w*(rows + 1))};
  Plane Surface(s) = {s}; roof[] += s;
EndFor
Transfinite Surface {floor[], roof[]}; Recombine Surface {floor[], roof[]};

vp[] = {}; vf[] = {}; vr[] = {};
out[] = Extrude {0, depth, 0} { Surface{1:s}; Layers{layers}; Recombine; };
m = 0;                                        // out: far face, volume, then a side for each edge
For k In {0:#pillar[]-1}
  vp[] += out[m + 1]; m = m + 5;
EndFor
For k In {0:n-1}
  vf[] += out[m + 1]; m = m + 6;
  vr[] += out[m + 1]; m = m + 6;
EndFor
eps = 1e-6; big = 100;
bottom[] = Surface In BoundingBox {-big, -big, -slab - eps, big, big, -slab + eps};
top[] = Surface In BoundingBox {-big, -big, height + slab - eps, big, big, height + slab + eps};
Physical Volume("pillar", 1) = {vp[]};
Physical Volume("floor", 2) = {vf[]};
Physical Volume("roof", 3) = {vr[]};
Physical Surface("bottom", 4) = {bottom[]};
Physical Surface("top", 5) = {top[]};
