// inner ring of a ball bearing; lengths in mm, x = radius, y = axial position, groove centres at 0
// mesh it with: gmsh -2 -order 1 -format msh41 FILE
side = -1; // 1: the body lies outside the groove, -1: inside
DefineConstant[
  seat_diameter = {30, Name "bore or outside diameter"},
  raceway_diameter = {36.4685, Name "diameter at the groove bottom"},
  groove_radius = {4.953, Name "groove radius"},
  shoulder_diameter_left = {40.3, Name "diameter of the shoulder below the groove"},
  shoulder_diameter_right = {40.3, Name "diameter of the shoulder above the groove"},
  width = {16, Name "width"},
  groove_offset = {0, Name "groove centres above the middle of the width"}
];
DefineConstant[
  groove_elements_left = {5, Name "elements on the groove below y = 0"},
  groove_elements_right = {5, Name "elements on the groove above y = 0"},
  shoulder_elements_left = {3, Name "elements on the shoulder below"},
  shoulder_elements_right = {3, Name "elements on the shoulder above"},
  thickness_elements = {6, Name "elements from raceway to seat"},
  grading = {1.2, Name "growth of the elements towards the seat"}
];
seat = seat_diameter/2; bottom = raceway_diameter/2; centre = bottom - side*groove_radius;
left = shoulder_diameter_left/2; right = shoulder_diameter_right/2;
groove_left = -Sqrt(groove_radius^2 - (left - centre)^2);
groove_right = Sqrt(groove_radius^2 - (right - centre)^2);
face_left = -width/2 - groove_offset; face_right = width/2 - groove_offset;
Point(1) = {left, face_left, 0}; Point(2) = {left, groove_left, 0}; Point(3) = {bottom, 0, 0};
Point(4) = {right, groove_right, 0}; Point(5) = {right, face_right, 0};
Point(6) = {seat, face_left, 0}; Point(7) = {seat, groove_left, 0}; Point(8) = {seat, 0, 0};
Point(9) = {seat, groove_right, 0}; Point(10) = {seat, face_right, 0}; Point(11) = {centre, 0, 0};
Line(1) = {1, 2}; Circle(2) = {2, 11, 3}; Circle(3) = {3, 11, 4}; Line(4) = {4, 5};
Line(5) = {6, 7}; Line(6) = {7, 8}; Line(7) = {8, 9}; Line(8) = {9, 10};
Line(11) = {1, 6}; Line(12) = {2, 7}; Line(13) = {3, 8}; Line(14) = {4, 9}; Line(15) = {5, 10};
Curve Loop(1) = {1, 12, -5, -11}; Plane Surface(1) = {1};
Curve Loop(2) = {2, 13, -6, -12}; Plane Surface(2) = {2};
Curve Loop(3) = {3, 14, -7, -13}; Plane Surface(3) = {3};
Curve Loop(4) = {4, 15, -8, -14}; Plane Surface(4) = {4};
Transfinite Curve{1, 5} = shoulder_elements_left + 1; Transfinite Curve{4, 8} = shoulder_elements_right + 1;
Transfinite Curve{2, 6} = groove_elements_left + 1; Transfinite Curve{3, 7} = groove_elements_right + 1;
Transfinite Curve{11, 12, 13, 14, 15} = thickness_elements + 1 Using Progression grading;
Transfinite Surface{1, 2, 3, 4}; Recombine Surface{1, 2, 3, 4};
Physical Surface("ring", 1) = {1, 2, 3, 4};
Physical Curve("raceway", 1) = {2, 3};
Physical Curve("shoulder", 3) = {1, 4};
Physical Curve("face", 4) = {11, 15};
Physical Curve("bore", 2) = {5, 6, 7, 8};
