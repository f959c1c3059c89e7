// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "holdfast/base/result.hpp"
#include "holdfast/io/document.hpp"

/// Formats of other programs, of which the cells are read and nothing is written. One table lists
/// them, for readers, help and documents.
namespace holdfast::io {

/// A row of the table.
struct ForeignFormat {
  std::string_view name;
  std::string_view endings;  ///< In small letters, separated by blanks: ".csv .txt".
  std::string_view content;  ///< What becomes of it, in a few words.
  std::string_view lost;     ///< What it does not say, or what is not read.

  /// Whether files of this format may end so, in small letters with the dot: ".csv".
  bool takes(std::string_view ending) const;
};

std::span<const ForeignFormat> foreign_formats();

/// The format of these that a text is in, by its first letters or, where they leave it open, by the
/// ending of the file; nullptr if it is none.
const ForeignFormat* find_foreign_format(std::string_view text, std::string_view ending);

/// Whether a file that begins so may have zero bytes, which no text has.
bool may_have_zero_bytes(std::string_view beginning, std::string_view ending);

/// Reads the cells of a format of this table, each as a module, whose lowest layer rests on the
/// ground. Errors: what is no such file, two modules in one cell, more modules than are allowed.
base::Result<ReadDocument> read_foreign(const ForeignFormat& format, std::string_view text,
                                        const ReadOptions& options = {});

}  // namespace holdfast::io
