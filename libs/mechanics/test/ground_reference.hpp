// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "holdfast/mechanics/ground_contact.hpp"
#include "paper.hpp"

/// A lopsided facet for the tests of ground contact (Ix != Iy, narrower than the pitch), and
/// Eqs. (7)-(12) of [Piranda 2021] written out literally.
namespace holdfast::test {

using base::Vec6;
using mechanics::ContactLaw;
using mechanics::ContactState;

inline constexpr double kFacetWidth = 30;
inline constexpr double kLever = 20;      // L/2
inline constexpr double kHalfWidth = 15;  // l
inline constexpr double kGamma = 1e-4;
/// Magnitudes of the terms for a displacement of 1 mm or 0.05 rad; N, N mm.
inline constexpr Vec6<double> kForceScale = {2e4, 2e4, 1e4, 4e5, 4e5, 4e4};

template <class Real>
mechanics::GroundFacet<Real> lopsided_facet(ContactLaw law, double gamma) {
  return mechanics::ground_facet(lopsided_section<Real>(), Real{kFacetWidth},
                                 static_cast<Real>(gamma), law);
}

/// Force at the node and state, in double, for a displacement that both scalars hold exactly.
struct Contact {
  Vec6<double> force{};
  ContactState state;
};

template <class Real>
Contact contact_at(const mechanics::GroundFacet<Real>& facet, const Vec6<double>& u,
                   bool is_held = true) {
  const auto real = converted<Real>(u);
  const ContactState state = mechanics::contact_state(facet, trial_force(facet, real));
  return {converted<double>(contact_force(facet, state, is_held, real)), state};
}

inline constexpr std::size_t kStateCount = 10;  // open, closed, four edges, four corners

inline std::vector<ContactState> all_states() {
  std::vector<ContactState> states = {{.pressed = false}};
  for (const int x : {-1, 0, 1}) {
    for (const int y : {-1, 0, 1}) {
      states.push_back({.pressed = true,
                        .tilt_x = static_cast<std::int8_t>(x),
                        .tilt_y = static_cast<std::int8_t>(y)});
    }
  }
  return states;
}

inline Vec6<double> difference(Vec6<double> a, const Vec6<double>& b) {
  for (std::size_t i = 0; i < 6; ++i) {
    a[i] -= b[i];
  }
  return a;
}

/// A vector between a and b, on the grid of float.
inline Vec6<double> blend(const Vec6<double>& a, const Vec6<double>& b, double weight_of_b) {
  Vec6<double> u{};
  for (std::size_t i = 0; i < 6; ++i) {
    u[i] = static_cast<double>(static_cast<float>(a[i] + weight_of_b * (b[i] - a[i])));
  }
  return u;
}

template <class Real>
void expect_equal_force(const Vec6<double>& force, const Vec6<double>& expected, double scale = 1) {
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(force[i], expected[i], kRounding<Real> * scale * kForceScale[i])
        << "component " << i;
  }
}

inline double sign(double value) { return value < 0 ? -1 : 1; }

/// Eqs. (7)-(12), line by line; L/2 is the lever of a force, l that of the pressure.
struct PaperContact {
  Vec6<double> force{};
  ContactState state;
  double slack_n = 0;  ///< Distance from the nearest change of case.

  explicit PaperContact(const Vec6<double>& u) {
    const Vec6<double> tr = image_of(paper_k11(lopsided_section<double>()), u);
    const double mx = tr[3] - tr[1] * kLever;
    const double my = tr[4] + tr[0] * kLever;
    const double phi_x = std::abs(mx) + tr[2] * kHalfWidth;
    const double phi_y = std::abs(my) + tr[2] * kHalfWidth;
    slack_n = std::min({std::abs(tr[2]), std::abs(phi_x) / kLever, std::abs(phi_y) / kLever});
    force = tr;
    if (tr[2] >= 0) {
      state = {.pressed = false};
      for (double& component : force) {
        component *= kGamma;
      }
      return;
    }
    if (phi_x >= 0) {
      state.tilt_x = mx < 0 ? -1 : 1;
      force[3] = kGamma * tr[3] + (1 - kGamma) * (kLever * tr[1] - kHalfWidth * sign(mx) * tr[2]);
    }
    if (phi_y >= 0) {
      state.tilt_y = my < 0 ? -1 : 1;
      force[4] = kGamma * tr[4] - (1 - kGamma) * (kLever * tr[0] + kHalfWidth * sign(my) * tr[2]);
    }
  }
};

}  // namespace holdfast::test
