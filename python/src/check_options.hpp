// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/holdfast.hpp"

namespace holdfast::python {

/// How to check; holdfast.Error for what is not allowed. `memory_gb` is in 2^30 bytes.
CheckOptions check_options(int thread_count, double memory_gb, bool is_bonded);

}  // namespace holdfast::python
