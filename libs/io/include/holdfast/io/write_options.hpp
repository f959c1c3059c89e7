// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace holdfast::io {

/// How a large report or picture is written. The bytes depend on none of it.
struct WriteOptions {
  int thread_count = 0;  ///< 0: as many as the machine has cores.
  /// A function that is called now and then with the share that is written, from 0 to 1.
  std::function<void(double share)> progress = {};
};

}  // namespace holdfast::io
