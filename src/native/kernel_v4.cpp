// The kernel for x86-64-v4 (AVX-512), with sixteen lanes. Compiled for those instructions alone
// (CMakeLists.txt); on other processors it is empty.
#include "native/kernel.h"

#ifdef WEFT_KERNELS_X86
#include <immintrin.h>

#define WEFT_LANES 16

namespace weft::native {
namespace {
#include "native/kernel_text.h"
constexpr Kernels kKernels = kernels_of("AVX-512", UpTo<kSweepVariants>::List{});
}  // namespace

const Kernels* kernels_v4() {
  __builtin_cpu_init();
  const bool there = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                     __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                     __builtin_cpu_supports("avx512vl");
  return there ? &kKernels : nullptr;
}

}  // namespace weft::native

#else
namespace weft::native {
const Kernels* kernels_v4() { return nullptr; }
}  // namespace weft::native
#endif
