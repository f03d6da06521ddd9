#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Vertex normals of a torn cloth: the normalised sum of the unnormalised normals of the adjacent triangles
// whose edges are whole.
// Each invocation gathers for its own vertex and writes only that: no races.
// Source: docs/float-form.md "Vertex normals".

#define TORN
#include "../shared/normals.glsl"
