// Which vector kernel this machine runs.
#pragma once
#include <span>
#include <string>

#include "native/kernel.h"

namespace weft::native {

/// The kernels that this machine has, the widest first; the last one is plain C++.
std::span<const Kernels* const> kernels_here();

/// The widest, or the one named: "AVX-512", "AVX2", "SSE" or "plain", in any case.
/// @param name  empty: WEFT_VECTOR, else the widest
/// @throws Error(Exit::usage) listing those that this machine has
const Kernels& find_kernels(const std::string& name = {});

}  // namespace weft::native
