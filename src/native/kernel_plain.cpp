// The kernel in plain C++ for any machine: four lanes, which the compiler maps to what the machine has.
#include "native/kernel.h"

#define WEFT_LANES 4

namespace weft::native {
namespace {
#include "native/kernel_text.h"
constexpr Kernels kKernels = kernels_of("plain", UpTo<kSweepVariants>::List{});
}  // namespace

const Kernels* kernels_plain() { return &kKernels; }

}  // namespace weft::native
