// The effects that only change arithmetic, as specialization constants; ids in the order of the
// declaration in src/passes/integrate.cpp. An effect the scene does not have costs nothing.
layout(constant_id = 0) const bool shear = true;
layout(constant_id = 1) const bool flex = true;
layout(constant_id = 2) const bool bending = true;
layout(constant_id = 3) const bool damping = true;
layout(constant_id = 4) const bool air = true;
layout(constant_id = 5) const bool wind = true;
layout(constant_id = 6) const bool gravity = true;
layout(constant_id = 7) const bool floor_contact = true;
layout(constant_id = 8) const bool spheres = true;
layout(constant_id = 9) const bool pins = true;
