#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Vertex normals: the normalised sum of the unnormalised normals of the adjacent triangles.
// Each invocation gathers for its own vertex and writes only that: no races.
// Source: docs/float-form.md "Vertex normals".

#include "../shared/normals.glsl"
