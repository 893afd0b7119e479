// A fortress of exactly 41,232 hexahedra: four towers, walls, a gate, a keep, battlements.
// Regions walls, towers, gate, keep, battlements; surface base (z = 0).   gmsh -3 fortress.geo
Include "lattice.geo";
Mesh.MshFileVersion = 2.2; Mesh.Binary = 1;

radius = 3.2; half = 1.0;                     // tower radius, half thickness of a wall (m)
ring = Sqrt(radius^2 - half^2);               // where the flat of a tower begins
opening = 1.0; pier = 1.2; wx = 1.0; wy = 1.05; merlons = 17;
cx = 2*opening + 2*pier; tx = cx + 7*wx; ox = tx + ring;         // ends of gate house and wall, centre of a tower
ty = merlons*wy/2; oy = ty + ring;

// Lattice planes and the elements between them, west to east, south to north, up
X[] = {-ox-ring, -ox-half, -ox, -ox+half}; NX[] = {5, 2, 2, 5};
For i In {0:6}
  X[] += -tx + i*wx; NX[] += 2;
EndFor
X[] += {-cx, -cx+pier, -2*opening, -opening, 0, opening, 2*opening, cx-pier}; NX[] += {3, 3, 3, 3, 3, 3, 3, 3};
For i In {0:6}
  X[] += cx + i*wx; NX[] += 2;
EndFor
X[] += {tx, ox-half, ox, ox+half, ox+ring}; NX[] += {5, 2, 2, 5};
Y[] = {-oy-ring, -oy-half, -oy, -oy+half}; NY[] = {5, 2, 2, 5};
For j In {0:merlons-1}
  Y[] += -ty + j*wy; NY[] += 3;
EndFor
Y[] += {ty, oy-half, oy, oy+half, oy+ring}; NY[] += {5, 2, 2, 5};
Z[] = {0, 2.4, 4.8, 6.1, 7.0, 9.0, 9.9, 11.6, 12.5}; NZ[] = {5, 6, 3, 2, 5, 2, 4, 2};

// What stands where: 1 walls, 2 towers, 3 gate, 4 keep, 5 battlements
ni = #NX[]; nj = #NY[]; nk = #NZ[]; part[] = {};
For k In {0:nk-1}
  For j In {0:nj-1}
    For i In {0:ni-1}
      im = (i < ni - 1 - i) ? i : ni - 1 - i;           // distance from the nearer end
      jm = (j < nj - 1 - j) ? j : nj - 1 - j;
      jk = Fabs(j - (nj - 1)/2);
      xmerlon = (im == 5 || im == 7 || im == 9 || im == 11 || im == 13);
      ymerlon = (j % 2 == 1);
      p = 0;
      If (im < 4 && jm < 4)                             // a tower and the crown on it
        If (k <= 4)
          p = 2;
        EndIf
        If (k == 5 && (im == 0 || im == 3) && (jm == 0 || jm == 3))
          p = 5;
        EndIf
      EndIf
      If (im >= 11 && j < 4)                            // the gate house
        If (k <= 4 && (k > 0 || im < 13))
          p = 3;
        EndIf
        If (k == 5 && (j == 0 || j == 3) && (im == 11 || im == 13))
          p = 5;
        EndIf
      EndIf
      If (im >= 4 && (j >= 4 || im < 11) && (jm == 1 || jm == 2))     // south and north wall
        If (k <= 2)
          p = 1;
        EndIf
        If (k == 3 && jm == 1 && xmerlon)
          p = 5;
        EndIf
      EndIf
      If (jm >= 4 && (im == 1 || im == 2))              // west and east wall
        If (k <= 2)
          p = 1;
        EndIf
        If (k == 3 && im == 1 && ymerlon)
          p = 5;
        EndIf
      EndIf
      If (im >= 11 && jk <= 3)                          // the keep: four walls, a roof, a door to the south
        edge = (im == 11 || jk == 3);
        If (k == 5 || (k <= 6 && edge))
          p = 4;
        EndIf
        If (k == 0 && im == 14 && j == (nj - 1)/2 - 3)
          p = 0;
        EndIf
        If (k == 7 && edge && (im - 11 + 3 - jk) % 2 == 0)
          p = 5;
        EndIf
      EndIf
      part[] += p;
    EndFor
  EndFor
EndFor

// Towers become round, the gate gets an arch
Macro Place
  ax = Fabs(px); ay = Fabs(py);
  If (ax > tx - 1e-6 && ay > ty - 1e-6)
    rx = ax - ox; ry = ay - oy;
    If (Fabs(rx) > half + 1e-6 && Fabs(ry) > half + 1e-6)
      rx = rx/Fabs(rx)*radius/Sqrt(2); ry = ry/Fabs(ry)*radius/Sqrt(2);
    ElseIf (Fabs(rx) > half + 1e-6 && Fabs(ry) < 1e-6)
      rx = rx/Fabs(rx)*radius;
    ElseIf (Fabs(ry) > half + 1e-6 && Fabs(rx) < 1e-6)
      ry = ry/Fabs(ry)*radius;
    EndIf
    px = px/ax*(ox + rx); py = py/ay*(oy + ry);
  EndIf
  If (k == 1 && ax < 2*opening - 1e-6 && j <= 4)
    pz = pz + 0.8*Sqrt(1 - (px/(2*opening))^2);
  EndIf
Return

Call Lattice;
If (count != 41232)
  Error("the fortress has %g hexahedra, not 41232", count);
EndIf

parts~{1}[] = {}; parts~{2}[] = {}; parts~{3}[] = {}; parts~{4}[] = {}; parts~{5}[] = {}; base[] = {};
For n In {0:points-1}
  If (has[n])
    q = has[n];
    parts~{q}[] += cell + n;
    If (n < dz)
      base[] += fz + n;
    EndIf
  EndIf
EndFor
Physical Volume("walls", 1) = {parts~{1}[]};
Physical Volume("towers", 2) = {parts~{2}[]};
Physical Volume("gate", 3) = {parts~{3}[]};
Physical Volume("keep", 4) = {parts~{4}[]};
Physical Volume("battlements", 5) = {parts~{5}[]};
Physical Surface("base", 6) = {base[]};
