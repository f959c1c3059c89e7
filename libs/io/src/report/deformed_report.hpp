// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "holdfast/io/report.hpp"

/// Reports the equilibria in the deformed shape.
namespace holdfast::io {

/// Adds the key deformed.
void write_deformed(JsonStream& json, const ReportEntry& entry);

/// A few lines, each with a line feed.
std::string deformed_text(const ReportEntry& entry);

}  // namespace holdfast::io
