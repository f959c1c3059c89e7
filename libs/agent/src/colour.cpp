// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/colour.hpp"

#include "holdfast/mechanics/connector.hpp"

namespace holdfast::agent {
namespace {

constexpr Colour kBlue = {.red = 0, .green = 0, .blue = 255};
constexpr Colour kPurple = {.red = 160, .green = 0, .blue = 255, .blinks = true};
constexpr Colour kRed = {.red = 255, .green = 0, .blue = 0, .blinks = true};
constexpr Colour kWhite = {.red = 255, .green = 255, .blue = 255};

/// Green at 0, yellow half way, orange just below 1.
Colour ramp(float ratio) {
  constexpr float kOrangeGreen = 128;
  const float share = ratio > 0 ? ratio : 0;
  if (share < 0.5F) {
    return {.red = static_cast<std::uint8_t>(510 * share), .green = 255, .blue = 0};
  }
  const float green = 255 - (255 - kOrangeGreen) * (2 * share - 1);
  return {.red = 255, .green = static_cast<std::uint8_t>(green), .blue = 0};
}

}  // namespace

Colour colour_of(Verdict verdict, float own_load_ratio, bool is_fixed, bool is_root) {
  switch (verdict) {
    case Verdict::kNone:
      return {};
    case Verdict::kUndecided:
      return kWhite;
    case Verdict::kUnstable:
      return is_root ? kPurple : Colour{};
    case Verdict::kSafe:
    case Verdict::kOverload:
      break;
  }
  if (mechanics::breaks(own_load_ratio)) {
    return kRed;
  }
  return is_fixed ? kBlue : ramp(own_load_ratio);
}

}  // namespace holdfast::agent
