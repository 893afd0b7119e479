// Hexahedra beside wedges, tetrahedra on top of the wedges; a quadrilateral fault between the first two.
// mixed_41a.msh, ...: gmsh -3 -format msh41 (msh22) [-bin] mixed.geo -o FILE
SetFactory("Built-in");
h = 0.5;
Point(1) = {0, 0, 0, h}; Point(2) = {1, 0, 0, h}; Point(3) = {2, 0, 0, h};
Point(4) = {0, 1, 0, h}; Point(5) = {1, 1, 0, h}; Point(6) = {2, 1, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 5}; Line(3) = {5, 4}; Line(4) = {4, 1};
Line(5) = {2, 3}; Line(6) = {3, 6}; Line(7) = {6, 5};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Curve Loop(2) = {5, 6, 7, -2}; Plane Surface(2) = {2};
Transfinite Curve {1:7} = 3;
Transfinite Surface {1};
Recombine Surface {1};
left[] = Extrude {0, 0, 1} { Surface{1}; Layers{2}; Recombine; };
right[] = Extrude {0, 0, 1} { Surface{2}; Layers{2}; Recombine; };

top = right[0];
loop[] = Boundary { Surface{top}; };
Point(100) = {1.4, 0.5, 1.8, h};
ends[] = {};
For i In {0 : 3}
  p[] = Boundary { Curve{loop[i]}; };
  ends[] += p[0];
  Line(100 + i) = {p[0], 100};
EndFor
For i In {0 : 3}
  p[] = Boundary { Curve{loop[i]}; };
  j = (i + 1) % 4;
  If (p[1] != ends[j])
    j = (i + 3) % 4;
  EndIf
  Curve Loop(200 + i) = {loop[i], 100 + j, -(100 + i)};
  Plane Surface(200 + i) = {200 + i};
EndFor
Surface Loop(300) = {top, 200, 201, 202, 203};
Volume(300) = {300};

Physical Volume("bricks", 7) = {left[1]};
Physical Volume("soft rock", 3) = {right[1]};
Physical Volume("cap", 11) = {300};
Physical Surface("bottom", 3) = {1, 2};
Physical Surface("fault", 5) = {left[3]};
Physical Surface("base of cap", 9) = {top};
Physical Curve("hinge", 2) = {2};
Physical Point("tip", 1) = {100};
