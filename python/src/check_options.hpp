// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common.hpp"

namespace holdfast::python {

/// Reads the options of a check; raises holdfast.Error for what is not allowed. `memory` is in GB
/// of 2^30 bytes.
CheckOptions check_options(const py::handle& threads, const py::handle& memory, bool is_bonded);

int thread_count_of(const py::handle& threads);

}  // namespace holdfast::python
