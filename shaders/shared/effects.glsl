// The effects that only change arithmetic, as specialization constants; ids in the order of the declaration
// in src/passes/integrate.cpp. An effect the scene does not have costs nothing. WEFT_LACKS_… takes one out as
// text: what a build that never had it would take, for `weft bench --effects`.
#ifdef WEFT_LACKS_shear
const bool shear = false;
#else
layout(constant_id = 0) const bool shear = true;
#endif
#ifdef WEFT_LACKS_flex
const bool flex = false;
#else
layout(constant_id = 1) const bool flex = true;
#endif
#ifdef WEFT_LACKS_bending
const bool bending = false;
#else
layout(constant_id = 2) const bool bending = true;
#endif
#ifdef WEFT_LACKS_damping
const bool damping = false;
#else
layout(constant_id = 3) const bool damping = true;
#endif
#ifdef WEFT_LACKS_air
const bool air = false;
#else
layout(constant_id = 4) const bool air = true;
#endif
#ifdef WEFT_LACKS_wind
const bool wind = false;
#else
layout(constant_id = 5) const bool wind = true;
#endif
#ifdef WEFT_LACKS_gravity
const bool gravity = false;
#else
layout(constant_id = 6) const bool gravity = true;
#endif
#ifdef WEFT_LACKS_floor
const bool floor_contact = false;
#else
layout(constant_id = 7) const bool floor_contact = true;
#endif
#ifdef WEFT_LACKS_spheres
const uint sphere_number = 0u;
#else
layout(constant_id = 8) const uint sphere_number = 1u;  // up to 2; more count as 3
#endif
#ifdef WEFT_LACKS_pins
const bool pins = false;
#else
layout(constant_id = 9) const bool pins = true;
#endif
