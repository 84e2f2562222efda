// two bricks side by side; groups ring, raceway (bottom), seat (top)
Point(1)={1,0,0}; Point(2)={2,0,0}; Point(3)={2,1,0}; Point(4)={1,1,0};
Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1};
Curve Loop(1)={1,2,3,4}; Plane Surface(1)={1};
Transfinite Curve{1,3}=3; Transfinite Curve{2,4}=2; Transfinite Surface{1};
DefineConstant[hex={1}];
If(hex) Recombine Surface{1}; EndIf
If(hex)
  o[]=Extrude{0,0,1}{Surface{1}; Layers{1}; Recombine;};
Else
  o[]=Extrude{0,0,1}{Surface{1}; Layers{1};};
EndIf
Physical Volume("ring",1)={o[1]}; Physical Surface("raceway",2)={1}; Physical Surface("seat",3)={o[0]};
Physical Curve("rim")={1};
