// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// One facet on the ground under both laws. Expected values: Eqs. (9)-(12) of [Piranda 2021] written
// out literally for the regularised law; for the unilateral law the conditions that define it (no
// corner below the ground, no pulling, no work), whose solution is unique. The section is lopsided
// (Ix != Iy) and the facet narrower than the pitch. Tolerances are the rounding of the scalar
// relative to the largest terms: about 4 kN and 1e5 N mm for a displacement of 1 mm or 0.05 rad.
#include "holdfast/mechanics/ground_contact.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "ground_reference.hpp"

namespace holdfast::mechanics {
namespace {

using namespace holdfast::test;

template <class Real>
class GroundContact : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(GroundContact, Scalars);

TYPED_TEST(GroundContact, regularised_is_the_predictor_corrector_of_the_paper) {
  const auto facet = lopsided_facet<TypeParam>(ContactLaw::kRegularised, kGamma);
  std::set<int> seen;
  base::Rng rng(1);
  for (int i = 0; i < 4000; ++i) {
    const auto u = random_displacement(rng);
    const PaperContact paper(u);
    if (paper.slack_n > 0.1) {  // Closer, a float may rightly choose the other case.
      const Contact contact = contact_at(facet, u);
      EXPECT_EQ(contact.state, paper.state);
      expect_equal_force<TypeParam>(contact.force, paper.force);
      seen.insert(contact.state.code());
    }
  }
  EXPECT_EQ(seen.size(), kStateCount);
}

TYPED_TEST(GroundContact, regularised_is_open_without_pressure_and_tilts_at_the_limit) {
  const auto facet = lopsided_facet<TypeParam>(ContactLaw::kRegularised, kGamma);
  const TypeParam l = kHalfWidth;
  EXPECT_EQ(contact_state(facet, Vec6<TypeParam>{}), (ContactState{.pressed = false}));
  EXPECT_EQ(contact_state(facet, {0, 0, -2, l, -l, 0}), ContactState{});
  EXPECT_EQ(contact_state(facet, {0, 0, -1, l, 0, 0}), (ContactState{.tilt_x = 1}));
  EXPECT_EQ(contact_state(facet, {0, 0, -1, 0, -l, 0}), (ContactState{.tilt_y = -1}));
}

/// Bisects between two displacements with different states; the force on both sides is the same.
/// The regularised law jumps where the pressure begins, so there both must be pressed.
template <class Real>
void expect_continuous(ContactLaw law) {
  const auto facet = lopsided_facet<Real>(law, kGamma);
  base::Rng rng(2);
  int change_count = 0;
  for (int i = 0; i < 4000; ++i) {
    auto a = random_displacement(rng);
    auto b = random_displacement(rng);
    const bool is_pressed =
        contact_at(facet, a).state.pressed && contact_at(facet, b).state.pressed;
    if (contact_at(facet, a).state == contact_at(facet, b).state ||
        (law == ContactLaw::kRegularised && !is_pressed)) {
      continue;
    }
    for (int step = 0; step < 30; ++step) {
      const auto middle = blend(a, b, 0.5);
      (contact_at(facet, middle).state == contact_at(facet, a).state ? a : b) = middle;
    }
    // The two ends are neighbours on the grid of float, whichever the scalar.
    expect_equal_force<float>(contact_at(facet, a).force, contact_at(facet, b).force);
    ++change_count;
  }
  EXPECT_GT(change_count, 500);
}

TYPED_TEST(GroundContact, regularised_begins_to_tilt_without_a_jump) {
  expect_continuous<TypeParam>(ContactLaw::kRegularised);
}

TYPED_TEST(GroundContact, unilateral_changes_state_without_a_jump) {
  expect_continuous<TypeParam>(ContactLaw::kUnilateral);
}

TYPED_TEST(GroundContact, is_the_plain_beam_to_a_node_below_while_closed) {
  const auto k11 =
      block_11(beam_stiffness(lopsided_section<TypeParam>()), base::Direction::kMinusZ);
  for (const ContactLaw law : {ContactLaw::kRegularised, ContactLaw::kUnilateral}) {
    const auto tangent = contact_tangent(lopsided_facet<TypeParam>(law, kGamma), {}, true);
    for (std::size_t i = 0; i < 36; ++i) {
      EXPECT_NEAR(static_cast<double>(tangent.values[i]), static_cast<double>(k11.values[i]),
                  kRounding<TypeParam> * std::abs(static_cast<double>(k11.values[i])));
    }
  }
}

/// Central differences: inside a state the force is linear, so only rounding over the step is left.
template <class Real>
void expect_tangent_is_derivative(ContactLaw law, bool is_held) {
  const auto facet = lopsided_facet<Real>(law, kGamma);
  std::set<int> seen;
  base::Rng rng(3);
  for (int i = 0; i < 2000; ++i) {
    const auto u = random_displacement(rng);
    const ContactState state = contact_at(facet, u).state;
    const auto tangent = contact_tangent(facet, state, is_held);
    for (std::size_t column = 0; column < 6; ++column) {
      const double h = column < 3 ? 1.0 / 32 : 1.0 / 512;
      auto up = u;
      auto down = u;
      up[column] += h;
      down[column] -= h;
      const Contact high = contact_at(facet, up, is_held);
      const Contact low = contact_at(facet, down, is_held);
      if (high.state != state || low.state != state) {
        continue;
      }
      Vec6<double> image{};
      for (std::size_t row = 0; row < 6; ++row) {
        image[row] = 2 * h * static_cast<double>(tangent.values[row + 6 * column]);
      }
      expect_equal_force<Real>(difference(high.force, low.force), image);
      seen.insert(state.code());
    }
  }
  EXPECT_EQ(seen.size(), kStateCount);
}

TYPED_TEST(GroundContact, has_the_derivative_of_its_force_as_tangent) {
  expect_tangent_is_derivative<TypeParam>(ContactLaw::kRegularised, true);
  expect_tangent_is_derivative<TypeParam>(ContactLaw::kUnilateral, true);
  expect_tangent_is_derivative<TypeParam>(ContactLaw::kUnilateral, false);
}

/// The action of the unilateral contact, seen from the facet centre: `force` (weak spring excluded)
/// and the rigid motion `v` of the facet that the beam was spared.
struct Release {
  Vec6<double> force{};
  Vec6<double> v{};

  template <class Real>
  Release(const GroundFacet<Real>& facet, const Vec6<double>& u, const Vec6<double>& node_force) {
    const Vec6<double> trial = converted<double>(trial_force(facet, converted<Real>(u)));
    const double gamma = static_cast<double>(facet.gamma);
    force = node_force;
    force[3] -= node_force[1] * kLever;
    force[4] += node_force[0] * kLever;
    for (std::size_t i = 0; i < 6; ++i) {
      force[i] = (force[i] - gamma * trial[i]) / (1 - gamma);
      v[i] = (trial[i] - force[i]) / static_cast<double>(facet.stiffness[i]);
    }
  }

  double corner_height(int side_x, int side_y) const {
    return v[2] + v[3] * side_y * kHalfWidth - v[4] * side_x * kHalfWidth;
  }
};

/// Eqs. (6)-(8) for a whole facet: no corner below the ground; pressure within the facet, never a
/// pull; no work of one on the other. The problem is convex, so nothing else fulfils all three.
TYPED_TEST(GroundContact, unilateral_keeps_corners_up_pushes_only_and_does_no_work) {
  std::set<int> seen;
  base::Rng rng(4);
  for (int i = 0; i < 4000; ++i) {
    const auto facet =
        lopsided_facet<TypeParam>(ContactLaw::kUnilateral, rng.below(2) == 0 ? 0 : kGamma);
    const auto u = random_displacement(rng);
    const Contact contact = contact_at(facet, u);
    const Release release(facet, u, contact.force);
    const double height_tolerance = kRounding<TypeParam> * 4;   // mm
    const double force_tolerance = kRounding<TypeParam> * 2e4;  // N
    for (const int side_x : {-1, 1}) {
      for (const int side_y : {-1, 1}) {
        const double height = release.corner_height(side_x, side_y);
        EXPECT_GT(height, -height_tolerance);
        // The state names the corners that stay down: mx^ < 0 presses +y, my^ > 0 presses +x.
        const bool stays = contact.state.pressed && contact.state.tilt_x != side_y &&
                           contact.state.tilt_y != -side_x;
        EXPECT_TRUE(!stays || height < height_tolerance);
      }
    }
    const Vec6<double>& force = release.force;
    EXPECT_LE(std::abs(force[3]), -force[2] * kHalfWidth + force_tolerance * kLever);
    EXPECT_LE(std::abs(force[4]), -force[2] * kHalfWidth + force_tolerance * kLever);
    const double work = force[2] * release.v[2] + force[3] * release.v[3] + force[4] * release.v[4];
    EXPECT_NEAR(work, 0, 4 * force_tolerance);
    seen.insert(contact.state.code());
  }
  EXPECT_EQ(seen.size(), kStateCount);
}

TYPED_TEST(GroundContact, unilateral_resists_slip_and_twist_only_while_held) {
  const auto facet = lopsided_facet<TypeParam>(ContactLaw::kUnilateral, 0);
  base::Rng rng(5);
  for (int i = 0; i < 1000; ++i) {
    const auto u = random_displacement(rng);
    const auto trial = converted<double>(trial_force(facet, converted<TypeParam>(u)));
    const auto held = contact_at(facet, u, true);
    const auto free = contact_at(facet, u, false);
    for (const std::size_t sideways : {0U, 1U, 5U}) {
      EXPECT_EQ(held.force[sideways], trial[sideways]);
      EXPECT_EQ(free.force[sideways], 0);
    }
    EXPECT_EQ(held.force[2], free.force[2]);
  }
}

/// A projection shortens distances: in every pair the work of the changes is at least the square
/// of the change of force over the stiffness, so the law is monotone and as stiff as the beam.
TYPED_TEST(GroundContact, unilateral_is_monotone_and_nowhere_stiffer_than_the_beam) {
  const auto facet = lopsided_facet<TypeParam>(ContactLaw::kUnilateral, kGamma);
  base::Rng rng(6);
  for (int i = 0; i < 4000; ++i) {
    const bool is_held = rng.below(2) == 0;
    const auto a = random_displacement(rng);
    const auto b = blend(a, random_displacement(rng), i % 2 == 0 ? 1 : 0.01);
    const auto change =
        difference(contact_at(facet, a, is_held).force, contact_at(facet, b, is_held).force);
    const double work = base::dot(change, difference(a, b));
    const double mx = change[3] - change[1] * kLever;
    const double my = change[4] + change[0] * kLever;
    const Vec6<double> at_facet = {change[0], change[1], change[2], mx, my, change[5]};
    double square = 0;
    for (std::size_t k = 0; k < 6; ++k) {
      square += at_facet[k] * at_facet[k] / static_cast<double>(facet.stiffness[k]);
    }
    EXPECT_GE(work, square - kRounding<TypeParam> * 4e4);
  }
}

/// Symmetric; and the weak spring keeps it at least gamma times as stiff as the beam.
TYPED_TEST(GroundContact, unilateral_has_a_symmetric_and_positive_tangent_in_every_state) {
  const auto facet = lopsided_facet<TypeParam>(ContactLaw::kUnilateral, 0.01);
  const Dense k11 = paper_k11(lopsided_section<double>());
  base::Rng rng(7);
  for (const ContactState state : all_states()) {
    for (const bool is_held : {false, true}) {
      const auto tangent = contact_tangent(facet, state, is_held);
      for (int row = 0; row < 6; ++row) {
        for (int column = 0; column < row; ++column) {
          EXPECT_NEAR(static_cast<double>(tangent.at(row, column)),
                      static_cast<double>(tangent.at(column, row)), kRounding<TypeParam> * 1e5);
        }
      }
      for (int i = 0; i < 200; ++i) {
        const auto u = random_displacement(rng);
        const auto force = converted<double>(multiply(tangent, converted<TypeParam>(u)));
        EXPECT_GE(base::dot(u, force),
                  0.01 * base::dot(u, image_of(k11, u)) - kRounding<TypeParam> * 2e4);
      }
    }
  }
}

/// The stand-in for solvers that need symmetry: at least gamma / 7 times as stiff as the beam. With
/// p = uz + ex tx + ey ty its energy is k0 p^2 + gamma (b1 tx^2 + b2 ty^2) where both tilt, and
/// k0 uz^2 <= 3 k0 (p^2 + l^2 tx^2 + l^2 ty^2), so what is lost is at most 1 + 3 k0 l^2 / b = 6.1.
TYPED_TEST(GroundContact, symmetric_tangent_is_symmetric_and_positive_in_every_state) {
  const Dense k11 = paper_k11(lopsided_section<double>());
  base::Rng rng(8);
  for (const ContactLaw law : {ContactLaw::kRegularised, ContactLaw::kUnilateral}) {
    const auto facet = lopsided_facet<TypeParam>(law, 0.01);
    for (const ContactState state : all_states()) {
      for (const bool is_held : {false, true}) {
        const auto tangent = symmetric_tangent(facet, state, is_held);
        for (int row = 0; row < 6; ++row) {
          for (int column = 0; column < row; ++column) {
            EXPECT_NEAR(static_cast<double>(tangent.at(row, column)),
                        static_cast<double>(tangent.at(column, row)), kRounding<TypeParam> * 1e5);
          }
        }
        for (int i = 0; i < 200; ++i) {
          const auto u = random_displacement(rng);
          const auto force = converted<double>(multiply(tangent, converted<TypeParam>(u)));
          EXPECT_GE(base::dot(u, force),
                    0.01 / 7 * base::dot(u, image_of(k11, u)) - kRounding<TypeParam> * 2e4);
        }
      }
    }
  }
}

/// Gauss's elimination finds positive pivots only, with the weak spring that is in use as well.
TEST(GroundFacet, symmetric_tangent_has_positive_pivots) {
  for (const ContactLaw law : {ContactLaw::kRegularised, ContactLaw::kUnilateral}) {
    for (const ContactState state : all_states()) {
      for (const bool is_held : {false, true}) {
        auto rest = symmetric_tangent(lopsided_facet<double>(law, kGamma), state, is_held);
        for (int pivot = 0; pivot < 6; ++pivot) {
          ASSERT_GT(rest.at(pivot, pivot), 0);
          for (int row = pivot + 1; row < 6; ++row) {
            const double factor = rest.at(row, pivot) / rest.at(pivot, pivot);
            for (int column = pivot; column < 6; ++column) {
              rest.at(row, column) -= factor * rest.at(pivot, column);
            }
          }
        }
      }
    }
  }
}

TYPED_TEST(GroundContact, symmetric_tangent_is_the_tangent_but_for_a_regularised_tilt) {
  int equal_count = 0;
  for (const ContactLaw law : {ContactLaw::kRegularised, ContactLaw::kUnilateral}) {
    const auto facet = lopsided_facet<TypeParam>(law, kGamma);
    for (const ContactState state : all_states()) {
      for (const bool is_held : {false, true}) {
        const auto tangent = contact_tangent(facet, state, is_held);
        const auto symmetric = symmetric_tangent(facet, state, is_held);
        double distance = 0;
        for (std::size_t i = 0; i < 36; ++i) {
          distance = std::max(distance, std::abs(static_cast<double>(tangent.values[i]) -
                                                 static_cast<double>(symmetric.values[i])));
        }
        const bool tilts = state.tilt_x != 0 || state.tilt_y != 0;
        const bool is_equal = law == ContactLaw::kUnilateral || !tilts;
        EXPECT_EQ(distance <= kRounding<TypeParam> * 1e6, is_equal) << state.code();
        equal_count += is_equal ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(equal_count, 24);  // All 20 of the unilateral law, open and closed of the other.
}

TYPED_TEST(GroundContact, symmetric_product_is_the_symmetric_tangent_times_the_displacement) {
  base::Rng rng(9);
  for (const ContactLaw law : {ContactLaw::kRegularised, ContactLaw::kUnilateral}) {
    const auto facet = lopsided_facet<TypeParam>(law, kGamma);
    for (const ContactState state : all_states()) {
      for (const bool is_held : {false, true}) {
        const auto tangent = symmetric_tangent(facet, state, is_held);
        for (int i = 0; i < 50; ++i) {
          const auto u = converted<TypeParam>(random_displacement(rng));
          expect_equal_force<TypeParam>(
              converted<double>(symmetric_product(facet, state, is_held, u)),
              converted<double>(multiply(tangent, u)));
        }
      }
    }
  }
}

/// A regularised facet that tilts: the spring EA/L stands under the pressed edge or corner, and so
/// does its force, as in Eqs. (11)-(12).
TYPED_TEST(GroundContact, symmetric_product_puts_the_spring_where_the_facet_presses) {
  const auto facet = lopsided_facet<TypeParam>(ContactLaw::kRegularised, 0);
  const double k0 = 100.0 * 1500 / 40;
  base::Rng rng(10);
  for (const ContactState state : all_states()) {
    if (state.tilt_x == 0 && state.tilt_y == 0) {
      continue;
    }
    const auto u = random_displacement(rng);
    const auto force =
        converted<double>(symmetric_product(facet, state, true, converted<TypeParam>(u)));
    const double fz = k0 * (u[2] - kHalfWidth * (state.tilt_x * u[3] + state.tilt_y * u[4]));
    const double tolerance = kRounding<TypeParam> * 2e4;
    EXPECT_NEAR(force[2], fz, tolerance);
    if (state.tilt_x != 0) {
      EXPECT_NEAR(force[3] - force[1] * kLever, -state.tilt_x * kHalfWidth * fz, tolerance * 20);
    }
    if (state.tilt_y != 0) {
      EXPECT_NEAR(force[4] + force[0] * kLever, -state.tilt_y * kHalfWidth * fz, tolerance * 20);
    }
  }
}

/// A weight W at a point of the plan pulls the node down with the torque r x F = (-y W, x W). The
/// centre of pressure, (-my^ / fz, mx^ / fz), stays within the facet, on the edge or corner that is
/// nearest to the weight.
TYPED_TEST(GroundContact, leaves_the_edge_pressed_over_which_the_weight_lies) {
  const TypeParam w = 8;
  const TypeParam out = 20;
  for (const ContactLaw law : {ContactLaw::kRegularised, ContactLaw::kUnilateral}) {
    const auto facet = lopsided_facet<TypeParam>(law, 0);
    for (const auto& [x, y] : {std::pair{0, 0}, {0, 1}, {0, -1}, {1, 0}, {-1, 0}, {1, -1}}) {
      const auto side_x = static_cast<TypeParam>(x);
      const auto side_y = static_cast<TypeParam>(y);
      const Vec6<TypeParam> trial = {0, 0, -w, -side_y * out * w, side_x * out * w, 0};
      const ContactState state = contact_state(facet, trial);
      EXPECT_EQ(state.tilt_x, -y);
      EXPECT_EQ(state.tilt_y, x);
      const auto force = multiply(corrector(facet, state, true), trial);
      EXPECT_LT(force[2], 0);
      EXPECT_NEAR(static_cast<double>(-force[4] / force[2]), x * kHalfWidth,
                  kRounding<TypeParam> * 20);
      EXPECT_NEAR(static_cast<double>(force[3] / force[2]), y * kHalfWidth,
                  kRounding<TypeParam> * 20);
    }
  }
}

/// One code for all that count, compare or tabulate states.
TEST(ContactState, has_a_code_for_each_state_and_back) {
  std::set<int> codes;
  for (const ContactState& state : all_states()) {
    EXPECT_TRUE(codes.insert(state.code()).second);
    EXPECT_EQ(ContactState::from_code(state.code()), state);
  }
  EXPECT_EQ(codes.size(), std::size_t{ContactState::kCodeCount});
  EXPECT_EQ(*codes.begin(), 0);
  EXPECT_EQ(*codes.rbegin(), ContactState::kCodeCount - 1);
}

}  // namespace
}  // namespace holdfast::mechanics
