// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace holdfast::io {

/// Numbers of each connection, module or facet that a table or picture has besides its own, by
/// index; an empty list: none is known, as one that is no number.
struct MoreNumbers {
  std::string name;  ///< Of the column or field, printable and without commas.
  std::vector<double> connections = {};
  std::vector<double> modules = {};
  std::vector<double> facets = {};
};

/// The options for writing a large report or picture. The bytes depend on none of them.
struct WriteOptions {
  int thread_count = 0;  ///< 0: as many as the machine has cores.
  /// A function that is called now and then with the share that is written, from 0 to 1.
  std::function<void(double share)> progress = {};
  std::vector<MoreNumbers> more = {};  ///< A column or field each, behind all others.
};

}  // namespace holdfast::io
