// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

/// Names that are not known, but look as if they were meant to be.
namespace holdfast::io {

using Names = std::span<const std::string_view>;

/// The name in the spelling that is known, if it is the same but for case; exactly the same counts
/// before all others.
std::optional<std::string_view> known_spelling(std::string_view name, Names known);

/// The known name that an unknown one is probably a slip of: the same but for case, '_' and '-',
/// with its words in another order, without its unit ("mass" for "mass_kg"), or, if it has four
/// letters or more, with one letter wrong, missing, too many or in its neighbour's place, from
/// eight letters on with two. None if it is like none, or is one of them.
std::optional<std::string_view> near_miss(std::string_view name, Names known);

/// "did you mean 'mass_kg'?"
std::string did_you_mean(std::string_view known);

}  // namespace holdfast::io
