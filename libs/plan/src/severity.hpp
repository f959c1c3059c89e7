// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/verdict/assessment.hpp"

namespace holdfast::plan {

using verdict::severity;

}  // namespace holdfast::plan
