// A column of 1 x 1 x 40 m: 20 m of rock in cells of 1 m below 20 m of soil in cells of half a metre.
// Regions rock, soil; surfaces base (z = 0), top (z = 40), sides.   gmsh -3 quiet_column.geo
Include "lattice.geo";
Mesh.MshFileVersion = 4.1; Mesh.Binary = 0;
X[] = {0, 1};      NX[] = {1};
Y[] = {0, 1};      NY[] = {1};
Z[] = {0, 20, 40}; NZ[] = {20, 40};
part[] = {1, 2};
Macro Place
Return
Call Lattice;
Physical Volume("rock", 1) = {cell};
Physical Volume("soil", 2) = {cell + dz};
Physical Surface("base", 3) = {fz};
Physical Surface("top", 4) = {fz + 2*dz};
Physical Surface("sides", 5) = {fx, fx + dx, fx + dz, fx + dx + dz, fy, fy + dy, fy + dz, fy + dy + dz};
