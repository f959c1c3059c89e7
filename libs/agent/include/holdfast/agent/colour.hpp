// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "holdfast/agent/messages/order.hpp"

namespace holdfast::agent {

/// What a module's lamp shows.
struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
  bool blinks = false;

  friend constexpr bool operator==(const Colour&, const Colour&) = default;
};

/// The colour of Fig. 6 of [Piranda 2021]: from green to orange by the largest load ratio of the
/// module's own connections, blinking red if one of them breaks, blue if it is fixed; if the robot
/// topples, the root blinks in purple and the others are dark. Our own: white while undecided, dark
/// before.
Colour colour_of(Verdict verdict, float own_load_ratio, bool is_fixed, bool is_root);

}  // namespace holdfast::agent
