// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/document.hpp"

#include <fmt/format.h>

#include "text_input.hpp"

namespace holdfast::io {

base::Result<Format> detect_format(std::string_view text) {
  text = trimmed(without_bom(text));
  if (text.starts_with('<')) {
    return Format::kVisibleSimXml;
  }
  if (text.starts_with('{') || text.starts_with('[')) {
    return Format::kJson;
  }
  if (text.empty()) {
    return base::Error{base::ErrorCode::kBadInput, "the input is empty, expected is a structure",
                       ""};
  }
  return base::Error{base::ErrorCode::kBadInput,
                     fmt::format("the input begins with {}, expected is VisibleSim XML, which "
                                 "begins with '<', or holdfast JSON, with '{{'",
                                 excerpt(text.substr(0, 8))),
                     ""};
}

base::Result<ReadDocument> read_document(std::string_view text, const ReadOptions& options) {
  const auto format = detect_format(text);
  if (!format) {
    return format.error();
  }
  return format.value() == Format::kJson ? read_json(text, options)
                                         : read_visiblesim(text, options);
}

}  // namespace holdfast::io
