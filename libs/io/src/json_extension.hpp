// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "json_values.hpp"

/// The members of a structure that only version 2 of the JSON format has.
namespace holdfast::io {

/// Reads the top-level member `key`, one of kExtensionKeys.
void read_extension_member(JsonReading& reading, std::string_view key, const Json& value,
                           const Place& place);

/// Reads one of kConnectorKeys, a member of the material.
void read_connector_parameter(JsonReading& reading, const std::string& key, const Json& value,
                              const Place& place);

/// Reads one of kOwnParameterKeys, a member of a module.
void read_own_parameter(JsonReading& reading, std::string_view key, const Json& value,
                        const Place& place, OwnParameters& own);

/// After all members: a failure if a module is of a kind that is none.
void check_kinds(JsonReading& reading);

}  // namespace holdfast::io
