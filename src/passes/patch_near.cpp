// patch_near: which patches may have something near that is not beside them on the cloth. Declaration and CPU
// mirror.
#include <utility>

#include "passes/parallel.h"
#include "passes/passes.h"
#include "passes/patches.h"

namespace weft {
namespace {

template <class T>
bool anything_near(const CollisionView<T>& view, const PatchGrid& patches, const PatchSearch<T>& search,
                   bool flat, std::uint32_t patch) {
  const auto low = search.low(patch), high = search.high(patch);
  if (!view.covered({low, T(0)}) || !view.covered({high, T(0)})) return false;
  if (!flat || !(search.distance() <= view.patch_search)) return true;
  bool found = false;
  const bool all = search.around(low, high, search.distance(), false, [&](std::uint32_t other) {
    found = !patches.beside(patch, other) &&
            PatchSearch<T>::gap(low, high, search.low(other), search.high(other)) < search.distance();
    return found;
  });
  return found || !all;
}

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  if (!lists_stale(buffers)) return;
  const CollisionView<T> view(context.model);
  const PatchGrid patches(context.model.grid);
  const auto& boxes = std::as_const(buffers)[BufferId::patches];
  auto& listed = buffers.words_of(BufferId::patch_listed);
  listed.resize(patches.count());
  const PatchSearch<T> search(view, buffers);
  parallel_rows(patches.rows(), 2 * std::uint64_t{view.grid.nx}, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t p = begin * patches.nx(); p < end * patches.nx(); ++p)
      listed[p] = anything_near(view, patches, search, boxes[2 * std::size_t{p}].w != T(0), p) ? 1 : 0;
  });
}

}  // namespace

const Pass patch_near = list_pass("patch_near", "self-collision: which patches may have another near",
                                  mirror<float>, mirror<double>, shared::kListGroups, patch_domain);

}  // namespace weft
