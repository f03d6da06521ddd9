// The kernel for x86-64-v3 (AVX2), with eight lanes. Compiled for those instructions alone (CMakeLists.txt);
// on other processors it is empty.
#include "native/kernel.h"

#ifdef WEFT_KERNELS_X86
#include <immintrin.h>

#define WEFT_LANES 8

namespace weft::native {
namespace {
#include "native/kernel_text.h"
constexpr Kernels kKernels = kernels_of("AVX2", UpTo<kSweepVariants>::List{});
}  // namespace

const Kernels* kernels_v3() {
  __builtin_cpu_init();
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2")
             ? &kKernels
             : nullptr;
}

}  // namespace weft::native

#else
namespace weft::native {
const Kernels* kernels_v3() { return nullptr; }
}  // namespace weft::native
#endif
