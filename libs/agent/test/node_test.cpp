// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What one module computes alone. Expected values: the blocks of libs/mechanics assembled and
// multiplied, closed forms, and mechanics' own contact force. The section is lopsided so that no
// two entries can be mistaken for each other.
#include "holdfast/agent/world/node.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "holdfast/base/rng.hpp"
#include "random_signed.hpp"

namespace holdfast::agent {
namespace {

void factor_block(Node& node, const Setup& setup, const ContactSetting& contact, Faces faces) {
  form_diagonal(node, setup, contact, faces, 0);
  form_diagonal(node, setup, contact, faces, 1);
  factor_diagonal(node, 0);
  factor_diagonal(node, 1);
}

using base::Mat6;
using base::Vec6;
using holdfast::test::random_signed;
using mechanics::ContactLaw;
using mechanics::ContactState;

auto lopsided_setup() {
  agent::Setup setup;
  setup.section = {.elastic_modulus = 100,
                   .length = 40,
                   .area = 1500,
                   .moment_x = 200'000,
                   .moment_y = 310'000,
                   .torsion = 130'000};
  setup.facet_mm = 30;
  setup.weight_n = 0.6;
  setup.strength_vertical_n = 12;
  setup.strength_lateral_n = 15;
  prepare(setup);
  return setup;
}

ContactSetting contact_of(const agent::Setup& setup, ContactLaw law, double gamma = 1e-4) {
  return {.facet = mechanics::ground_facet(setup.section, setup.facet_mm, gamma, law),
          .lever_mm = 200};
}

template <class Real>
Vec6<Real> random_vector(base::Rng& rng, double length, double angle) {
  Vec6<Real> vector{};
  for (std::size_t i = 0; i < 6; ++i) {
    vector[i] = static_cast<Real>(random_signed(rng) * (i < 3 ? length : angle));
  }
  return vector;
}

ContactState random_state(base::Rng& rng) {
  const auto tilt = [&] { return static_cast<std::int8_t>(static_cast<int>(rng.below(3)) - 1); };
  if (rng.below(4) == 0) {
    return {.pressed = false};
  }
  return {.pressed = true, .tilt_x = tilt(), .tilt_y = tilt()};
}

/// The diagonal block, from the same blocks that the exact solver assembles.
Mat6<double> assembled(const agent::Setup& setup, Faces faces) {
  Mat6<double> block;
  for (const base::Direction direction : faces) {
    base::add_to(block, mechanics::block_11(setup.beam, direction));
  }
  return block;
}

TEST(Setup, prepare_derives_the_beam_in_both_precisions) {
  const auto setup = lopsided_setup();
  EXPECT_EQ(setup.beam.axial, 100.0 * 1500 / 40);
  EXPECT_FLOAT_EQ(setup.beam_float.bend_x, 4.0F * 100 * 200'000 / 40);
  EXPECT_FLOAT_EQ(setup.beam_float.twist, 100.0F * 130'000 / 40);
}

TEST(Node, reset_brings_back_to_rest) {
  const auto setup = lopsided_setup();
  for (const bool is_fixed : {false, true}) {
    for (const bool is_ground : {false, true}) {
      Node node;
      node.is_fixed = is_fixed;
      node.is_ground = is_ground;
      node.is_held = false;
      node.was_released = true;
      node.u = {1, 2, 3, 4, 5, 6};
      node.force = {1, 2, 3, 4, 5, 6};
      reset(node);
      EXPECT_TRUE(node.is_held);
      EXPECT_FALSE(node.was_released);
      EXPECT_EQ(node.state, (ContactState{.pressed = is_ground}));
      EXPECT_EQ(node.wanted, node.state);
      EXPECT_EQ(node.u, Vec6<double>{});
      EXPECT_EQ(node.force, Vec6<double>{});
      const ContactSetting contact = contact_of(setup, ContactLaw::kRegularised);
      const Vec6<double> weight = {0, 0, -0.6, 0, 0, 0};
      EXPECT_EQ(residual(node, setup, contact), is_fixed ? Vec6<double>{} : weight);
    }
  }
}

/// x -> block x -> solve gives x. In the metric of the block, where entries are alike in size: an
/// error of rounding in a displacement counts by the force it makes. 1e-5 leaves room for
/// the condition number of a block, some 30 when scaled; gamma = 0.01 keeps that of an open facet.
TEST(Node, solve_undoes_multiplication_by_the_block) {
  const double tolerance = 1e-5;
  const auto setup = lopsided_setup();
  base::Rng rng(1);
  for (int round = 0; round < 2000; ++round) {
    const auto law = rng.below(2) == 0 ? ContactLaw::kRegularised : ContactLaw::kUnilateral;
    const ContactSetting contact = contact_of(setup, law, 0.01);
    Node node;
    node.is_ground = rng.below(2) == 0;
    node.is_held = rng.below(2) == 0;
    node.state = random_state(rng);
    const auto faces = Faces::from_mask(static_cast<std::uint8_t>(1 + rng.below(63)));
    Mat6<double> block = assembled(setup, faces);
    if (node.is_ground) {
      base::add_to(block, mechanics::symmetric_tangent(contact.facet, node.state, node.is_held));
    }
    const Vec6<double> x = random_vector<double>(rng, 1, 0.05);
    const Vec6<double> image = base::multiply(block, x);
    Vec6<float> rounded{};
    for (std::size_t i = 0; i < 6; ++i) {
      rounded[i] = static_cast<float>(image[i]);
    }
    factor_block(node, setup, contact, faces);
    const Vec6<float> back = solve_diagonal(node, rounded);
    Vec6<double> error{};
    for (std::size_t i = 0; i < 6; ++i) {
      error[i] = static_cast<double>(back[i]) - x[i];
    }
    const double size = std::sqrt(base::dot(x, image));
    EXPECT_LE(std::sqrt(base::dot(error, base::multiply(block, error))), tolerance * size)
        << "faces " << int{faces.mask()};
  }
}

TEST(Node, a_fixed_module_does_not_move) {
  const auto setup = lopsided_setup();
  const ContactSetting contact = contact_of(setup, ContactLaw::kRegularised);
  Node node;
  node.is_fixed = true;
  node.force = {1, 2, 3, 4, 5, 6};
  factor_block(node, setup, contact, Faces::all());
  EXPECT_EQ(solve_diagonal(node, {1, 2, 3, 4, 5, 6}), Vec6<float>{});
  EXPECT_EQ(residual(node, setup, contact), Vec6<double>{});
}

TEST(Node, at_rest_the_residual_is_the_weight) {
  const auto setup = lopsided_setup();
  for (const auto law : {ContactLaw::kRegularised, ContactLaw::kUnilateral}) {
    Node node;
    node.is_ground = true;
    reset(node);
    EXPECT_EQ(residual(node, setup, contact_of(setup, law)), (Vec6<double>{0, 0, -0.6, 0, 0, 0}));
  }
}

TEST(Node, the_residual_is_weight_less_beams_less_facet) {
  const auto setup = lopsided_setup();
  base::Rng rng(3);
  for (int round = 0; round < 200; ++round) {
    const auto law = rng.below(2) == 0 ? ContactLaw::kRegularised : ContactLaw::kUnilateral;
    const ContactSetting contact = contact_of(setup, law);
    Node node;
    node.is_ground = rng.below(2) == 0;
    node.is_held = rng.below(2) == 0;
    node.state = random_state(rng);
    node.u = random_vector<double>(rng, 1, 0.05);
    node.force = random_vector<double>(rng, 10, 100);
    Vec6<double> facet{};
    if (node.is_ground) {
      facet = mechanics::contact_force(contact.facet, node.state, node.is_held, node.u);
    }
    const Vec6<double> rest = residual(node, setup, contact);
    for (std::size_t i = 0; i < 6; ++i) {
      // Three terms are added in another order: a few roundings of the largest.
      const double size = 1 + std::abs(node.force[i]) + std::abs(facet[i]);
      EXPECT_NEAR(rest[i], (i == 2 ? -0.6 : 0.0) - node.force[i] - facet[i], 1e-15 * size);
    }
  }
}

TEST(Node, the_state_is_the_one_that_mechanics_prescribes) {
  const auto setup = lopsided_setup();
  base::Rng rng(4);
  std::array<int, 2> counts{};
  for (int round = 0; round < 500; ++round) {
    const auto law = rng.below(2) == 0 ? ContactLaw::kRegularised : ContactLaw::kUnilateral;
    const ContactSetting contact = contact_of(setup, law);
    Node node;
    node.is_ground = true;
    node.u = random_vector<double>(rng, 1, 0.05);
    const ContactState state =
        mechanics::contact_state(contact.facet, mechanics::trial_force(contact.facet, node.u));
    EXPECT_EQ(prescribed_state(node, contact), state);
    ++counts[state.pressed ? 1 : 0];
  }
  EXPECT_GT(std::min(counts[0], counts[1]), 100);
}

TEST(Node, above_the_ground_there_is_no_contact) {
  const auto setup = lopsided_setup();
  const ContactSetting contact = contact_of(setup, ContactLaw::kRegularised);
  Node node;
  node.u = {0, 0, -1, 0, 0, 0};
  EXPECT_EQ(prescribed_state(node, contact), (ContactState{.pressed = false}));
}

/// Eq. (17) for the force F at the robot's full extent R and a torque T, on the weaker connector:
/// (2 (T + F R) / a + F) / Fmax, with a = 30, R = 200, Fmax = 12; sums of magnitudes.
TEST(Node, the_error_of_a_residual_is_the_load_ratio_it_could_make) {
  auto setup = lopsided_setup();
  const ContactSetting contact = contact_of(setup, ContactLaw::kRegularised);
  const Vec6<double> rest = {1, -2, 0.5, -10, 20, 30};
  const double force = 3.5;
  const double torque = 60;
  const double expected = (2 * (torque + force * 200) / 30 + force) / 12;
  EXPECT_DOUBLE_EQ(ratio_error(rest, setup, contact), expected);
  setup.strength_lateral_n = 6;
  EXPECT_DOUBLE_EQ(ratio_error(rest, setup, contact), 2 * expected);
  EXPECT_EQ(ratio_error(Vec6<double>{}, setup, contact), 0);
  EXPECT_TRUE(std::isnan(
      ratio_error(Vec6<double>{0, 0, 0, 0, static_cast<double>(NAN), 0}, setup, contact)));
}

/// A cantilever: a module that hangs on a fixed one bends its connection by its weight times half a
/// pitch. The bound on what its whole weight could do, unbalanced, is larger.
TEST(Node, the_bound_is_above_what_a_cantilever_carries) {
  const auto setup = lopsided_setup();
  ContactSetting contact = contact_of(setup, ContactLaw::kRegularised);
  contact.lever_mm = 2 * setup.section.length;
  Node node;
  reset(node);
  const double carried = 2 * (0.6 * 20) / 30 / 15;
  EXPECT_GT(ratio_error(load_of(node, setup), setup, contact), carried);
}

}  // namespace
}  // namespace holdfast::agent
