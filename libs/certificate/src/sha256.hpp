// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace holdfast::certificate {

/// SHA-256, hexadecimal [NIST 2015].
std::string sha256(std::string_view text);

}  // namespace holdfast::certificate
