// inner ring of a ball bearing; lengths in mm, axis = z, groove centres at 0
// mesh it with: gmsh -3 -order 2 -format msh41 FILE
side = -1; // 1: the body lies outside the groove, -1: inside
DefineConstant[
  seat_diameter = {50, Name "bore or outside diameter"},
  raceway_diameter = {56.01, Name "diameter at the groove bottom"},
  groove_radius = {4.65, Name "groove radius"},
  shoulder_diameter_left = {60.4, Name "diameter of the shoulder below the groove"},
  shoulder_diameter_right = {60.4, Name "diameter of the shoulder above the groove"},
  width = {16, Name "width"},
  groove_offset = {0, Name "groove centres above the middle of the width"}
];
DefineConstant[
  size = {1.6, Name "element size"}
];
seat = seat_diameter/2; bottom = raceway_diameter/2; centre = bottom - side*groove_radius;
left = shoulder_diameter_left/2; right = shoulder_diameter_right/2;
groove_left = -Sqrt(groove_radius^2 - (left - centre)^2);
groove_right = Sqrt(groove_radius^2 - (right - centre)^2);
face_left = -width/2 - groove_offset; face_right = width/2 - groove_offset;
SetFactory("OpenCASCADE");
Point(1) = {left, 0, face_left}; Point(2) = {left, 0, groove_left}; Point(3) = {bottom, 0, 0};
Point(4) = {right, 0, groove_right}; Point(5) = {right, 0, face_right};
Point(6) = {seat, 0, face_right}; Point(7) = {seat, 0, face_left}; Point(8) = {centre, 0, 0};
Line(1) = {1, 2}; Circle(2) = {2, 8, 3}; Circle(3) = {3, 8, 4}; Line(4) = {4, 5};
Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6, 7}; Plane Surface(1) = {1};
o[] = Extrude{{0, 0, 1}, {0, 0, 0}, 2*Pi}{ Surface{1}; };
Delete{ Surface{1}; }
Mesh.MeshSizeMax = size; Mesh.MeshSizeMin = size/4; Mesh.MeshSizeFromCurvature = 12;
Physical Volume("ring", 1) = {o[1]};
Physical Surface("raceway", 1) = {o[3], o[4]};
Physical Surface("shoulder", 3) = {o[2], o[5]};
Physical Surface("face", 4) = {o[6], o[8]};
Physical Surface("bore", 2) = {o[7]};
