// Four stopes of 8 x 12 m with pillars of 6 m between them, in a slice of 110 x 1 x 72 m of rock. Hexahedra.
// Regions rock, pillars, stope_1 ... stope_4 (along x); surfaces bottom, top (z = -36, 36), sides (x = -55, 55), ends (y).
//                                                                                          gmsh -3 stopes.geo
Include "lattice.geo";
Mesh.MshFileVersion = 2.2; Mesh.Binary = 1;
X[] = {-55, -25, -17, -11, -3, 3, 11, 17, 25, 55}; NX[] = {15, 8, 6, 8, 6, 8, 6, 8, 15};
Y[] = {0, 1};                                      NY[] = {1};
Z[] = {-36, -6, 6, 36};                            NZ[] = {15, 12, 15};
part[] = {1,1,1,1,1,1,1,1,1,  1,1,1,1,1,1,1,1,1,  1,1,1,1,1,1,1,1,1};
Macro Place
Return
Call Lattice;
rock[] = {cell + dz, cell + dz + 8}; bottom[] = {}; top[] = {}; sides[] = {}; ends[] = {};
For i In {0:8}
  rock[] += {cell + i, cell + i + 2*dz};
  bottom[] += fz + i; top[] += fz + i + 3*dz;
  For k In {0:2}
    ends[] += {fy + i + k*dz, fy + i + k*dz + dy};
  EndFor
EndFor
For k In {0:2}
  sides[] += {fx + k*dz, fx + k*dz + 9};
EndFor
Physical Volume("rock", 1) = {rock[]};
Physical Volume("pillars", 2) = {cell + dz + 2, cell + dz + 4, cell + dz + 6};
Physical Volume("stope_1", 3) = {cell + dz + 1};
Physical Volume("stope_2", 4) = {cell + dz + 3};
Physical Volume("stope_3", 5) = {cell + dz + 5};
Physical Volume("stope_4", 6) = {cell + dz + 7};
Physical Surface("bottom", 7) = {bottom[]};
Physical Surface("top", 8) = {top[]};
Physical Surface("sides", 9) = {sides[]};
Physical Surface("ends", 10) = {ends[]};
