// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/io/document.hpp"

/// Pieces of JSON text that a person is to read. `indent` is always that of the line which the
/// opening bracket stands in.
namespace holdfast::io {

using Items = std::vector<std::string>;

/// A line is at most so long, where its parts allow it.
inline constexpr std::size_t kColumns = 100;

/// An object or array of a single line may be so long, its key before it.
inline constexpr std::size_t kShortMax = 78;

std::string json_text(const std::string& value);

/// The shortest text that reads back as the same number.
std::string json_text(double value);

/// The text of the number, or "null".
std::string json_text(const std::optional<double>& value);

std::string json_text(const base::Cell& cell);
std::string json_text(std::span<const base::Cell> cells);
std::string json_text(const Color& color);

std::string member(std::string_view key, const std::string& value);

/// An object on one line.
std::string object(const Items& members);

/// An object on one line if that is a short one, else with a member a line.
std::string object(const Items& members, std::size_t indent);

/// An array on one line.
std::string row(const Items& items);

/// An array with an item a line.
std::string array(const Items& items, std::size_t indent);

/// An object or array with an item a line.
std::string lines(char open, const Items& items, char close, std::size_t indent);

/// The members of a structure that only version 2 of the format has, as they follow "support_z",
/// "material", its own, and "planned".
void add_setting_members(Items& members, const Extension& extension,
                         const base::Lattice& default_lattice);
void add_kind_members(Items& members, const Extension& extension);
void add_obstacle_members(Items& members, const Extension& extension);
void add_connection_members(Items& members, const Extension& extension);
void add_plan_members(Items& members, const Extension& extension);

/// Members of the material that only version 2 has.
Items material_extension_members(const Extension& extension);

/// An object of the members that VisibleSim XML has no words for: all but the lattice, obstacles
/// and what modules have of their own; empty if there are none.
std::string extension_text(const Extension& extension);

/// A module's own parameters, as members of it.
void add_own_members(Items& members, const OwnParameters& own);

}  // namespace holdfast::io
