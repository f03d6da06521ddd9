// The kernel for x86-64-v2, with four lanes. Compiled for those instructions alone (CMakeLists.txt);
// on other processors it is empty.
#include "native/kernel.h"

#ifdef WEFT_KERNELS_X86
#include <immintrin.h>

#define WEFT_LANES 4
#define WEFT_SSE 1

namespace weft::native {
namespace {
#include "native/kernel_text.h"
constexpr Kernels kKernels = kernels_of("SSE", UpTo<kSweepVariants>::List{});
}  // namespace

const Kernels* kernels_v2() {
  __builtin_cpu_init();
  return __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt") ? &kKernels : nullptr;
}

}  // namespace weft::native

#else
namespace weft::native {
const Kernels* kernels_v2() { return nullptr; }
}  // namespace weft::native
#endif
