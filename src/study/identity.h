// What makes two studies the same: the scene in canonical words, hashed; and where results are kept.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "scene/scene.h"

namespace weft::study {

/// Raised when what is kept on disk means something else than before; older files are then ignored.
inline constexpr int kFormatVersion = 1;

/// Every value that the motion depends on, one `section.key=value` a line with 17 digits: cloth, material,
/// pins, effects, the frame's length. Title, file name, solver settings and [expect] are not in it, so that
/// settings of one scene can be compared.
std::string canonical_scene(const Scene& scene);

/// FNV-1a, 64 bits.
std::uint64_t hash_of(std::string_view bytes);

/// hash_of as 16 hexadecimal digits: a file name.
std::string name_of(std::string_view bytes);

/// Makes a folder with those above it. Returns false when that is not possible.
bool make_folder(const std::filesystem::path& folder);

}  // namespace weft::study
