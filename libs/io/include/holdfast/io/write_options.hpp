// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace holdfast::io {

/// The options for writing a large report or picture. The bytes depend on none of them.
struct WriteOptions {
  int thread_count = 0;  ///< 0: as many as the machine has cores.
  /// A function that is called now and then with the share that is written, from 0 to 1.
  std::function<void(double share)> progress = {};
};

}  // namespace holdfast::io
