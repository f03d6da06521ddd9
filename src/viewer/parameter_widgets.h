// A widget for every row of the parameter table, and sections that can be switched on and off.
#pragma once
#include <string>
#include <string_view>

#include "scene/parameters.h"

namespace weft {

/// How much larger than on an ordinary display text and widgets are.
float ui_scale();

/// A slider, number field or choice for one parameter, with its unit, and its meaning as a tooltip.
/// @param label  in place of the key; empty: the key
/// @return       whether the scene was changed. A value that breaks the row's rule is not taken.
bool parameter_widget(const Parameter& parameter, Scene& scene, std::size_t item,
                      std::string_view label = {});

/// All parameters of a section with its switch; list sections item by item.
/// @param cost  of the effect, shown beside its name; may be empty
/// @return      whether the scene was changed
bool section_widget(std::string_view section, Scene& scene, const std::string& cost = {});

/// Adds an optional section with values that show its effect, where the table requires one.
void add_visible_section(Scene& scene, std::string_view section);

}  // namespace weft
