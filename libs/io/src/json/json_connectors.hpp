// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "json/json_values.hpp"

/// Parameters of connections in holdfast JSON, of the material and of kinds of modules.
namespace holdfast::io {

/// Whether a key of the material is one of version 2.
bool is_material_extension(std::string_view key);

/// Reads such a member of the material.
void read_material_extension(JsonReading& reading, const std::string& key, const Json& value,
                             const JsonPlace& place);

/// Reads a kind of modules.
KindEntry read_kind(JsonReading& reading, const std::string& name, const Json& value,
                    const JsonPlace& place);

/// Reads one of kConnectorKeys.
void read_connector_parameter(JsonReading& reading, const std::string& key, const Json& value,
                              const JsonPlace& place, Connectors& connectors);

/// Whether a key of the material is one of kScatterKeys.
bool is_scatter_key(std::string_view key);

/// Reads one of kScatterKeys.
void read_scatter(JsonReading& reading, const std::string& key, const Json& value,
                  const JsonPlace& place, Scatter& scatter);

/// Says why strengths or masses cannot scatter so much or so little, if they cannot; `key` is one
/// of kKindScatterKeys.
std::optional<std::string> find_cv_fault(std::string_view key, double cv);

/// A failure if an object of the material or a kind says the strength of a direction twice.
void expect_one_strength(JsonReading& reading, const Json& value, const JsonPlace& place);

/// Fails if a list does not have one value for each pair of the lattice's directions; to be called
/// when all members are read.
void check_pair_lists(JsonReading& reading);

/// A number that is not negative, such as a coefficient of friction or a width.
double read_not_negative(JsonReading& reading, const Json& value, const JsonPlace& place);

/// A number of kPositiveMin and more.
double read_positive(JsonReading& reading, const Json& value, const JsonPlace& place);

/// The index of a name, an enumerator; 0, and a failure, if it is none of them.
std::size_t read_choice(JsonReading& reading, const Json& value, const JsonPlace& place,
                        Names names);

}  // namespace holdfast::io
