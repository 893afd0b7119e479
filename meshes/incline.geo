// A block of 4 x 4 x 2 m on a slab. Regions slab, block; surfaces base, contact.   gmsh -3 incline.geo
Include "lattice.geo";
Mesh.MshFileVersion = 2.2; Mesh.Binary = 0;
X[] = {-3, -2, 2, 3}; NX[] = {1, 2, 1};
Y[] = {-2, 2};        NY[] = {2};
Z[] = {-1, 0, 2};     NZ[] = {1, 2};
part[] = {1, 1, 1,  0, 2, 0};
Macro Place
Return
Call Lattice;
Physical Volume("slab", 1) = {cell, cell + dx, cell + 2*dx};
Physical Volume("block", 2) = {cell + dx + dz};
Physical Surface("base", 3) = {fz, fz + dx, fz + 2*dx};
Physical Surface("contact", 4) = {fz + dx + dz};
