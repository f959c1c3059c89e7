// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "holdfast/io/report.hpp"

/// Reports the limit load.
namespace holdfast::io {

/// Adds the keys limit_load_factor and limit_load.
void write_limit(JsonStream& json, const ReportEntry& entry);

/// One line or two, each with a line feed.
std::string limit_text(const ReportEntry& entry);

}  // namespace holdfast::io
