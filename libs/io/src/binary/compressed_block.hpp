// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace holdfast::io {

/// The page comes without the library that compresses.
#ifdef __EMSCRIPTEN__
inline constexpr bool kCompresses = false;
#else
inline constexpr bool kCompresses = true;
#endif

/// A block in zlib's format [RFC 1950], compressed for speed; the same bytes for the same block.
std::string compressed(std::string_view block);

}  // namespace holdfast::io
