// A tunnel of radius 4 m in 60 x 10 x 60 m of rock, cut by a fault that ends inside the rock. Tetrahedra.
// Region rock; surfaces bottom, top, sides (x = +-30), ends (y = 0, 10), wall (of the tunnel), fault.   gmsh -3 tunnel.geo
SetFactory("OpenCASCADE");
Mesh.MshFileVersion = 2.2; Mesh.Binary = 1;

half = 30; depth = 10; radius = 4;
dip = 55*Pi/180; strike = 15*Pi/180;          // the fault strikes 15 degrees off the tunnel's axis
down = 22; up = 22;                           // its length down and up the dip from the tunnel
Box(1) = {-half, 0, -half, 2*half, depth, 2*half};
Cylinder(2) = {0, 0, 0, 0, depth, 0, radius};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };

// the fault: a rectangle wider than the slab; what sticks out is thrown away
Rectangle(100) = {-up, -depth, 0, up + down, 3*depth};
Rotate {{0, 1, 0}, {0, 0, 0}, dip} { Surface{100}; }
Rotate {{0, 0, 1}, {0, depth/2, 0}, strike} { Surface{100}; }
Translate {1.5, 0, 0} { Surface{100}; }
fault() = BooleanIntersection{ Surface{100}; Delete; }{ Volume{3}; };
pieces() = BooleanFragments{ Volume{3}; Delete; }{ Surface{fault()}; Delete; };

eps = 1e-3; big = 1000;
rock() = Volume{:};
watch = newp; Point(watch) = {-24, 5, -16};   // a node for the history point of options/tunnel.yaml
Point{watch} In Volume{rock(0)};
bottom() = Surface In BoundingBox {-big, -big, -half - eps, big, big, -half + eps};
top() = Surface In BoundingBox {-big, -big, half - eps, big, big, half + eps};
sides() = Surface In BoundingBox {-half - eps, -big, -big, -half + eps, big, big};
sides() += Surface In BoundingBox {half - eps, -big, -big, half + eps, big, big};
ends() = Surface In BoundingBox {-big, -eps, -big, big, eps, big};
ends() += Surface In BoundingBox {-big, depth - eps, -big, big, depth + eps, big};
wall() = Surface In BoundingBox {-radius - eps, -eps, -radius - eps, radius + eps, depth + eps, radius + eps};
wall() -= ends();
inner() = Surface{:};
inner() -= {bottom(), top(), sides(), ends(), wall()};

Physical Volume("rock", 1) = {rock()};
Physical Surface("bottom", 2) = {bottom()};
Physical Surface("top", 3) = {top()};
Physical Surface("sides", 4) = {sides()};
Physical Surface("ends", 5) = {ends()};
Physical Surface("wall", 6) = {wall()};
Physical Surface("fault", 7) = {inner()};

// 1.2 m at the tunnel, 2.4 m far from it
Field[1] = Distance; Field[1].SurfacesList = {wall()};
Field[2] = Threshold; Field[2].InField = 1;
Field[2].SizeMin = 1.2; Field[2].SizeMax = 2.4; Field[2].DistMin = 0; Field[2].DistMax = 14;
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromPoints = 0;
Mesh.Algorithm3D = 1; Mesh.Optimize = 1; Mesh.OptimizeThreshold = 0.5;
