// Asks for every variable of docs/cli.md that has a rule of its own. Folders (WEFT_ASSETS) and what needs a
// plan (WEFT_PERTURB) are checked where they are used.
#include "cli/environment.h"

#include <cstdlib>

#include "cli/text.h"
#include "core/environment.h"
#include "native/features.h"
#include "sim/kernels.h"

namespace weft::cli {

void check_environment() {
  native::wished_threads();
  native::find_kernels();
  for (const char* name : {"WEFT_FORCE_STAGING", "WEFT_WITHOUT_FLOAT64", "WEFT_SIMULATE_DEVICE_LOSS_AFTER",
                           "WEFT_FAIL_ALLOCATION_AFTER_BYTES"})
    environment_number(name);
  if (const char* kernel = std::getenv("WEFT_KERNEL"))
    parse_word("The environment variable WEFT_KERNEL", kernel, kernel_names());
}

}  // namespace weft::cli
