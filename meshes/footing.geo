// Half of a strip footing of 2 m on soil of 5 x 2.5 m, one element thick; the footing is a pillar of 1.5 m.
// Regions soil, footing; surfaces base, top (of the footing), ends (x = 0, 5), faces (y).   gmsh -3 footing.geo
Include "lattice.geo";
Mesh.MshFileVersion = 2.2; Mesh.Binary = 1;
n = 16;                                       // cells under the half footing
X[] = {0, 1, 2, 5};         NX[] = {n, n, 3*n/2};
Y[] = {0, 0.0625};          NY[] = {1};
Z[] = {-2.5, -1.5, 0, 1.5}; NZ[] = {n/2, 3*n/2, n/2};
part[] = {1, 1, 1,  1, 1, 1,  2, 0, 0};
Macro Place
Return
Call Lattice;
Physical Volume("soil", 1) = {cell, cell + dx, cell + 2*dx, cell + dz, cell + dx + dz, cell + 2*dx + dz};
Physical Volume("footing", 2) = {cell + 2*dz};
Physical Surface("base", 3) = {fz, fz + dx, fz + 2*dx};
Physical Surface("top", 4) = {fz + 3*dz};
Physical Surface("ends", 5) = {fx, fx + dz, fx + 2*dz, fx + 3*dx, fx + 3*dx + dz};
near[] = {fy, fy + dx, fy + 2*dx, fy + dz, fy + dx + dz, fy + 2*dx + dz, fy + 2*dz}; far[] = {};
For i In {0:#near[]-1}
  far[] += near[i] + dy;
EndFor
Physical Surface("faces", 6) = {near[], far[]};
