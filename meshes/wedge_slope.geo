// A rock slope, 8 m high with a face of 65 degrees, in which two joints cut out a wedge. Tetrahedra.
// The joints meet in a line that dips 35 degrees out of the slope and comes out of the face at z = 2; each stands 55 degrees
// from the upright plane y = 0 through that line. Regions wedge, rock; surface outside (all but face, crest and bench);
// the joints are between:wedge:rock.   gmsh -3 wedge_slope.geo
SetFactory("OpenCASCADE");
Mesh.MshFileVersion = 2.2; Mesh.Binary = 1;
Mesh.CharacteristicLengthMax = 1.6;

degree = Pi/180; height = 8; slope = 65*degree; plunge = 35*degree; half = 55*degree;
crest = -height/Tan(slope); wide = 8; back = -13; front = 4; deep = -3;
Point(1) = {back, -wide, deep}; Point(2) = {front, -wide, deep}; Point(3) = {front, -wide, 0};
Point(4) = {0, -wide, 0}; Point(5) = {crest, -wide, height}; Point(6) = {back, -wide, height};
For i In {1:6}
  Line(i) = {i, i % 6 + 1};
EndFor
Curve Loop(1) = {1:6}; Plane Surface(1) = {1};
out[] = Extrude {0, 2*wide, 0} { Surface{1}; };

// The joints: from the line, 3 m beyond face and crest, upward and to the side
x0 = -2/Tan(slope); z0 = 2; long = 6/Sin(plunge);
ax = x0 + 3*Cos(plunge); az = z0 - 3*Sin(plunge);
bx = x0 - (long + 3)*Cos(plunge); bz = z0 + (long + 3)*Sin(plunge);
up = 14; ux = up*Sin(plunge)*Cos(half); uz = up*Cos(plunge)*Cos(half); uy = up*Sin(half);
Point(101) = {ax, 0, az}; Point(102) = {bx, 0, bz};
Point(103) = {bx + ux, uy, bz + uz}; Point(104) = {ax + ux, uy, az + uz};
Point(105) = {bx + ux, -uy, bz + uz}; Point(106) = {ax + ux, -uy, az + uz};
Line(101) = {101, 102}; Line(102) = {102, 103}; Line(103) = {103, 104}; Line(104) = {104, 101};
Line(105) = {102, 105}; Line(106) = {105, 106}; Line(107) = {106, 101};
Curve Loop(101) = {101, 102, 103, 104}; Plane Surface(101) = {101};
Curve Loop(102) = {101, 105, 106, 107}; Plane Surface(102) = {102};
parts[] = BooleanFragments{ Volume{out[1]}; Delete; }{ Surface{101, 102}; Delete; };

eps = 1e-3; big = 100;
all[] = Volume{:};
wedge[] = Volume In BoundingBox {back + eps, -wide + eps, deep + eps, big, wide - eps, big};
rock[] = all[]; rock[] -= wedge[];
Physical Volume("wedge", 1) = {wedge[]};
Physical Volume("rock", 2) = {rock[]};
outside[] = Surface In BoundingBox {back - eps, -big, -big, back + eps, big, big};
outside[] += Surface In BoundingBox {front - eps, -big, -big, front + eps, big, big};
outside[] += Surface In BoundingBox {-big, -wide - eps, -big, big, -wide + eps, big};
outside[] += Surface In BoundingBox {-big, wide - eps, -big, big, wide + eps, big};
outside[] += Surface In BoundingBox {-big, -big, deep - eps, big, big, deep + eps};
Physical Surface("outside", 3) = {outside[]};
Printf("volumes %g, of the wedge %g, outside %g", #all[], #wedge[], #outside[]);
// Finer round the wedge
Field[1] = Box; Field[1].VIn = 0.9; Field[1].VOut = 2.2; Field[1].Thickness = 2;
Field[1].XMin = -10; Field[1].XMax = 0; Field[1].YMin = -5.5; Field[1].YMax = 5.5; Field[1].ZMin = 1.5; Field[1].ZMax = 8;
Background Field = 1;
Mesh.CharacteristicLengthExtendFromBoundary = 0; Mesh.CharacteristicLengthFromPoints = 0;
