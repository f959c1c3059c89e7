// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/beside_one.hpp"

#include "holdfast/host/text.hpp"
#include "holdfast/verdict/assessment.hpp"

namespace holdfast::io {

std::string beside_one(double number, int decimals) {
  return host::beside_one(number, decimals, verdict::kLoadRatioTie);
}

}  // namespace holdfast::io
