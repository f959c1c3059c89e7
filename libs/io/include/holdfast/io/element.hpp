// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

/// Stores the parts of VisibleSim XML that a structure keeps as they stand there.
namespace holdfast::io {

/// Names and values, in the order of the file.
using Attributes = std::vector<std::pair<std::string, std::string>>;

/// An XML element that mechanics have no use for, kept whole (camera, spotlight, csg).
struct Element {
  std::string name;
  Attributes attributes;
  std::string text;  ///< All of it in one piece, without white space at its ends.
  std::vector<Element> children;

  friend bool operator==(const Element&, const Element&) = default;
};

struct Color {
  int red = 0;  ///< 0 to 255, as the others.
  int green = 0;
  int blue = 0;

  friend bool operator==(const Color&, const Color&) = default;
};

}  // namespace holdfast::io
