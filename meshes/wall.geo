// A dry wall in running bond on a plinth: 8 courses of stones 1 x 0.5 x 0.5 m, each 2 x 1 x 2 hexahedra.
// Regions plinth, stones_a, stones_b, stones_c (no two stones of one letter touch);
// surfaces bed, head (horizontal and vertical joints), foot (wall on plinth), base.   gmsh -3 wall.geo
Include "lattice.geo";
Mesh.MshFileVersion = 4.1; Mesh.Binary = 1;

stones = 10; courses = 8; length = 1.0; height = 0.5; thickness = 0.5;
X[] = {}; NX[] = {};
For i In {0:2*stones}
  X[] += (i - stones)*length/2; NX[] += 1;
EndFor
Y[] = {0, thickness}; NY[] = {1};
Z[] = {}; NZ[] = {};
For k In {0:courses+1}
  Z[] += (k - 1)*height; NZ[] += 2;
EndFor
part[] = {};
For k In {0:courses}
  For i In {0:2*stones-1}
    If (k == 0)
      part[] += 4;
    Else
      odd = (k - 1) % 2;
      b = Floor((i + odd)/2);                 // stone of this course; odd courses begin with half a stone
      part[] += 1 + ((b + odd) % 3);
    EndIf
  EndFor
EndFor
Macro Place
Return
Call Lattice;

stones~{1}[] = {}; stones~{2}[] = {}; stones~{3}[] = {}; stones~{4}[] = {};
base[] = {}; foot[] = {}; bed[] = {}; head[] = {};
For k In {0:nz-1}
  For i In {0:nx-1}
    n = i + dz*k;
    q = has[n];
    stones~{q}[] += cell + n;
    If (k == 0)
      base[] += fz + n;
    ElseIf (k == 1)
      foot[] += fz + n;
    Else
      bed[] += fz + n;
    EndIf
    If (k > 0 && i > 0 && (i + k - 1) % 2 == 0)
      head[] += fx + n;
    EndIf
  EndFor
EndFor
Physical Volume("stones_a", 1) = {stones~{1}[]};
Physical Volume("stones_b", 2) = {stones~{2}[]};
Physical Volume("stones_c", 3) = {stones~{3}[]};
Physical Volume("plinth", 4) = {stones~{4}[]};
Physical Surface("base", 5) = {base[]};
Physical Surface("foot", 6) = {foot[]};
Physical Surface("bed", 7) = {bed[]};
Physical Surface("head", 8) = {head[]};
