// A slice of 60 x 1 x 60 m of rock with a tunnel of radius 3 m yet to be dug. Wedges, one layer.
// Regions rock, tunnel (what is dug out); surfaces bottom, top (z = -30, 30), sides (x = -30, 30), ends (y = 0, 1),
// line keel (x = 0, z = -30).                                                  gmsh -3 staged_tunnel.geo
Mesh.MshFileVersion = 2.2; Mesh.Binary = 1;
half = 30; thick = 1; radius = 3;
near = 0.5; far = 2;                          // edges at the tunnel and at the outside
Point(1) = {-half, 0, -half, far}; Point(2) = {0, 0, -half, far}; Point(3) = {half, 0, -half, far};
Point(4) = {half, 0, half, far}; Point(5) = {-half, 0, half, far};
Point(6) = {0, 0, 0, near}; Point(7) = {radius, 0, 0, near}; Point(8) = {0, 0, radius, near};
Point(9) = {-radius, 0, 0, near}; Point(10) = {0, 0, -radius, near};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 1};
Circle(6) = {7, 6, 8}; Circle(7) = {8, 6, 9}; Circle(8) = {9, 6, 10}; Circle(9) = {10, 6, 7};
Curve Loop(1) = {1, 2, 3, 4, 5}; Curve Loop(2) = {6, 7, 8, 9};
Plane Surface(1) = {1, 2}; Plane Surface(2) = {2};
Point(11) = {-24, 0, -15, far}; Point{11} In Surface{1};   // a node for the history point rock
Extrude {0, thick, 0} { Surface{1, 2}; Layers{1}; Recombine; }
eps = 1e-3; big = 1000;
bottom() = Surface In BoundingBox {-big, -big, -half - eps, big, big, -half + eps};
top() = Surface In BoundingBox {-big, -big, half - eps, big, big, half + eps};
sides() = Surface In BoundingBox {-half - eps, -big, -big, -half + eps, big, big};
sides() += Surface In BoundingBox {half - eps, -big, -big, half + eps, big, big};
ends() = Surface In BoundingBox {-big, -eps, -big, big, eps, big};
ends() += Surface In BoundingBox {-big, thick - eps, -big, big, thick + eps, big};
keel() = Curve In BoundingBox {-eps, -eps, -half - eps, eps, thick + eps, -half + eps};
Physical Volume("rock", 1) = {1};
Physical Volume("tunnel", 2) = {2};
Physical Surface("bottom", 3) = {bottom()};
Physical Surface("top", 4) = {top()};
Physical Surface("sides", 5) = {sides()};
Physical Surface("ends", 6) = {ends()};
Physical Curve("keel", 7) = {keel()};
Mesh.Algorithm = 6;
