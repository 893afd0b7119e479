// Structured hexahedra on a lattice: Macro Lattice, included by the scenes that are made of boxes.
//
// Before the call:     X[] Y[] Z[]     lattice planes
//                      NX[] NY[] NZ[]  elements in each interval
//                      part[]          one number a lattice cell, x fastest: 0 = empty
//                      Macro Place     moves the lattice point px, py, pz of index i, j, k
// After the call:      volume of cell (i,j,k) = cell + its point number;
//                      face with normal x, y, z at point n = fx + n, fy + n, fz + n;
//                      count = hexahedra; has[] says which cells are filled (indexed by point number).
// The point number of (i,j,k) is i + px1*(j + py1*k), that of its lowest corner.

Macro Lattice
nx = #X[] - 1; ny = #Y[] - 1; nz = #Z[] - 1;
px1 = nx + 1; py1 = ny + 1; points = px1*py1*(nz + 1);
stride = points + 1;
lx = 1; ly = lx + stride; lz = ly + stride;   // curves
fx = 1; fy = fx + stride; fz = fy + stride;   // faces
cell = 1;                                     // volumes

has[] = {}; up[] = {}; ulx[] = {}; uly[] = {}; ulz[] = {}; ufx[] = {}; ufy[] = {}; ufz[] = {};
For n In {0:points-1}
  has[] += 0; up[] += 0; ulx[] += 0; uly[] += 0; ulz[] += 0; ufx[] += 0; ufy[] += 0; ufz[] += 0;
EndFor

dx = 1; dy = px1; dz = px1*py1;
count = 0;
For k In {0:nz-1}
  For j In {0:ny-1}
    For i In {0:nx-1}
      p = part[i + nx*(j + ny*k)];
      If (p > 0)
        n = i + px1*(j + py1*k);
        has[n] = p;
        count = count + NX[i]*NY[j]*NZ[k];
        up[n] = 1; up[n+dx] = 1; up[n+dy] = 1; up[n+dx+dy] = 1;
        up[n+dz] = 1; up[n+dx+dz] = 1; up[n+dy+dz] = 1; up[n+dx+dy+dz] = 1;
        ulx[n] = 1; ulx[n+dy] = 1; ulx[n+dz] = 1; ulx[n+dy+dz] = 1;
        uly[n] = 1; uly[n+dx] = 1; uly[n+dz] = 1; uly[n+dx+dz] = 1;
        ulz[n] = 1; ulz[n+dx] = 1; ulz[n+dy] = 1; ulz[n+dx+dy] = 1;
        ufx[n] = 1; ufx[n+dx] = 1; ufy[n] = 1; ufy[n+dy] = 1; ufz[n] = 1; ufz[n+dz] = 1;
      EndIf
    EndFor
  EndFor
EndFor

For k In {0:nz}
  For j In {0:ny}
    For i In {0:nx}
      n = i + px1*(j + py1*k);
      If (up[n])
        px = X[i]; py = Y[j]; pz = Z[k];
        Call Place;
        Point(n + 1) = {px, py, pz};
      EndIf
    EndFor
  EndFor
EndFor
For k In {0:nz}
  For j In {0:ny}
    For i In {0:nx}
      n = i + px1*(j + py1*k);
      If (ulx[n])
        Line(lx + n) = {n + 1, n + dx + 1};
        Transfinite Curve {lx + n} = NX[i] + 1;
      EndIf
      If (uly[n])
        Line(ly + n) = {n + 1, n + dy + 1};
        Transfinite Curve {ly + n} = NY[j] + 1;
      EndIf
      If (ulz[n])
        Line(lz + n) = {n + 1, n + dz + 1};
        Transfinite Curve {lz + n} = NZ[k] + 1;
      EndIf
    EndFor
  EndFor
EndFor
For n In {0:points-1}
  If (ufx[n])
    Curve Loop(fx + n) = {ly + n, lz + n + dy, -(ly + n + dz), -(lz + n)};
    Surface(fx + n) = {fx + n}; Transfinite Surface {fx + n}; Recombine Surface {fx + n};
  EndIf
  If (ufy[n])
    Curve Loop(fy + n) = {lx + n, lz + n + dx, -(lx + n + dz), -(lz + n)};
    Surface(fy + n) = {fy + n}; Transfinite Surface {fy + n}; Recombine Surface {fy + n};
  EndIf
  If (ufz[n])
    Curve Loop(fz + n) = {lx + n, ly + n + dx, -(lx + n + dy), -(ly + n)};
    Surface(fz + n) = {fz + n}; Transfinite Surface {fz + n}; Recombine Surface {fz + n};
  EndIf
EndFor
For n In {0:points-1}
  If (has[n])
    Surface Loop(cell + n) = {fx + n, fx + n + dx, fy + n, fy + n + dy, fz + n, fz + n + dz};
    Volume(cell + n) = {cell + n};
    Transfinite Volume {cell + n};
  EndIf
EndFor
Return
