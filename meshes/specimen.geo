// A specimen of 0.1 x 0.1 x 0.2 m with a load cell of 0.1 m on it.
// Regions specimen, cell; surfaces base, top, west (x = 0), south (y = 0), sides (the others of the
// specimen).   gmsh -3 specimen.geo
Include "lattice.geo";
Mesh.MshFileVersion = 2.2; Mesh.Binary = 1;
X[] = {0, 0.1};       NX[] = {6};
Y[] = {0, 0.1};       NY[] = {6};
Z[] = {0, 0.2, 0.3}; NZ[] = {12, 6};
part[] = {1, 2};
Macro Place
Return
Call Lattice;
Physical Volume("specimen", 1) = {cell};
Physical Volume("cell", 2) = {cell + dz};
Physical Surface("base", 3) = {fz};
Physical Surface("top", 4) = {fz + 2*dz};
Physical Surface("west", 5) = {fx, fx + dz};
Physical Surface("south", 6) = {fy, fy + dz};
Physical Surface("sides", 7) = {fx + dx, fy + dy};
