// The section of docs/stability.md on crushed cloth.
#pragma once
#include <string>

namespace weft::hard {

/// Runs crushed cloths and tells what became of their energy, as Markdown.
std::string crush_section();

}  // namespace weft::hard
