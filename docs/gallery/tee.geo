// A pipe with a branch: two cylinders made one, with the physical groups that a solver asks for.
SetFactory("OpenCASCADE");
Cylinder(1) = {-2, 0, 0, 4, 0, 0, 0.5};
Cylinder(2) = {0, 0, 0, 0, 0, 1.5, 0.35};
pipe() = BooleanUnion{ Volume{1}; Delete; }{ Volume{2}; Delete; };
in() = Surface In BoundingBox{-2.1, -1, -1, -1.9, 1, 1};
out() = Surface In BoundingBox{1.9, -1, -1, 2.1, 1, 1};
branch() = Surface In BoundingBox{-1, -1, 1.4, 1, 1, 1.6};
wall() = Boundary{ Volume{pipe()}; };
wall() -= {in(), out(), branch()};
Physical Surface("inlet", 1) = in();
Physical Surface("outlet", 2) = out();
Physical Surface("branch", 3) = branch();
Physical Surface("wall", 4) = wall();
Physical Volume("water", 5) = pipe();
