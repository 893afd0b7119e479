// A box of n x n x n hexahedra, for the benchmark of set-up: gmsh -3 -setnumber n 100 box.geo
DefineConstant[ n = 10 ];
Point(1) = {0, 0, 0};
line[] = Extrude {n, 0, 0} { Point{1}; Layers{n}; };
face[] = Extrude {0, n, 0} { Curve{line[1]}; Layers{n}; Recombine; };
body[] = Extrude {0, 0, n} { Surface{face[1]}; Layers{n}; Recombine; };
Physical Volume("rock") = {body[1]};
Physical Surface("base") = {face[1]};
