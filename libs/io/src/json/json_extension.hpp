// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "json/json_values.hpp"

/// The members of a structure that only version 2 of the JSON format has.
namespace holdfast::io {

/// Reads the top-level member `key`, one of kExtensionKeys.
void read_extension_member(JsonReading& reading, std::string_view key, const Json& value,
                           const JsonPlace& place);

/// Reads one of kOwnParameterKeys, a member of a module.
void read_own_parameter(JsonReading& reading, std::string_view key, const Json& value,
                        const JsonPlace& place, OwnParameters& own);

/// Reads the object that extension_text() has written, and checks kinds and lists of numbers; the
/// lattice, what modules have of their own and obstacles are there already.
void read_extension_text(Reading& reading, std::string_view text, const Reading::Where& where);

/// Sorts the modules' own parameters, and fails if a module's kind is not defined; to be called
/// when all members are read.
void check_kinds(JsonReading& reading);

}  // namespace holdfast::io
