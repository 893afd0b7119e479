// A bar of 800 x 1 x 1 m, one hexahedron a metre, with a joint in its middle.
// Regions left, right; surfaces start (x = 0), end (x = 800), sides, joint.   gmsh -3 jointed_bar.geo
Include "lattice.geo";
Mesh.MshFileVersion = 4.1; Mesh.Binary = 0;
X[] = {0, 400, 800}; NX[] = {400, 400};
Y[] = {0, 1};        NY[] = {1};
Z[] = {0, 1};        NZ[] = {1};
part[] = {1, 2};
Macro Place
Return
Call Lattice;
Physical Volume("left", 1) = {cell};
Physical Volume("right", 2) = {cell + dx};
Physical Surface("start", 3) = {fx};
Physical Surface("joint", 4) = {fx + dx};
Physical Surface("end", 5) = {fx + 2*dx};
Physical Surface("sides", 6) = {fy, fy + dx, fy + dy, fy + dy + dx, fz, fz + dx, fz + dz, fz + dz + dx};
