// Which vector kernel this machine runs, and what the environment asks of native.
#pragma once
#include <cstdint>
#include <optional>
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

inline constexpr std::uint32_t kThreadsMax = 1024;

/// The most threads that WEFT_THREADS allows; nothing when it is not set.
/// @throws Error(Exit::usage) when it is no number from 1 to kThreadsMax
std::optional<std::uint32_t> wished_threads();

}  // namespace weft::native
