// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/node.hpp"

#include "scalar.hpp"

namespace holdfast::agent {
namespace {

using base::Mat6;
using base::Vec6;

std::size_t at(int row, int column) {
  return static_cast<std::size_t>(row * (row + 1) / 2 + column);
}

/// Sum of K11 over the beams on `faces`.
Mat6<double> beam_block(const Setup& setup, base::Faces faces) {
  Mat6<double> block;
  for (const base::Direction direction : faces) {
    base::add_to(block, mechanics::block_11(setup.beam, direction));
  }
  return block;
}

Vec6<double> position_along(const Node& node, const Vec6<float>& g, double t) {
  Vec6<double> u = node.u;
  for (std::size_t i = 0; i < 6; ++i) {
    u[i] += t * static_cast<double>(g[i]);
  }
  return u;
}

}  // namespace

void prepare(Setup& setup) {
  setup.beam = mechanics::beam_stiffness(setup.section);
  const mechanics::BeamSection<double>& section = setup.section;
  setup.beam_float = mechanics::beam_stiffness(
      mechanics::BeamSection<float>{.elastic_modulus = static_cast<float>(section.elastic_modulus),
                                    .length = static_cast<float>(section.length),
                                    .area = static_cast<float>(section.area),
                                    .moment_x = static_cast<float>(section.moment_x),
                                    .moment_y = static_cast<float>(section.moment_y),
                                    .torsion = static_cast<float>(section.torsion)});
}

void reset(Node& node) {
  node.is_held = true;
  node.was_released = false;
  node.state = {.pressed = node.is_ground};
  node.wanted = node.state;
  node.u = {};
  node.force = {};
}

Gradients gradients_at_rest(const Node& node, const Setup& setup) {
  Gradients rest{};
  if (!node.is_fixed) {
    rest.r[2] = static_cast<float>(-setup.weight_n);
  }
  rest.r_start = rest.r;
  return rest;
}

void factor_diagonal(Node& node, const Setup& setup, const ContactSetting& contact,
                     base::Faces faces) {
  Mat6<double> block = beam_block(setup, faces);
  if (node.is_ground) {
    base::add_to(block, mechanics::symmetric_tangent(contact.facet, node.state, node.is_held));
  }
  Triangle factor{};
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column <= row; ++column) {
      auto sum = static_cast<float>(block.at(row, column));
      for (int k = 0; k < column; ++k) {
        sum -= factor[at(row, k)] * factor[at(column, k)];
      }
      factor[at(row, column)] = row == column ? square_root(sum) : sum / factor[at(column, column)];
    }
  }
  node.matrix.factor = factor;
}

Mat6<double> diagonal_block(const Node& node, const Setup& setup, const ContactSetting& contact,
                            base::Faces faces) {
  Mat6<double> block = beam_block(setup, faces);
  if (node.is_ground) {
    base::add_to(block, mechanics::contact_tangent(contact.facet, node.state, node.is_held));
  }
  return block;
}

Vec6<float> scalar_diagonal(const Node& node, const Setup& setup, const ContactSetting& contact,
                            base::Faces faces) {
  const Mat6<double> block = diagonal_block(node, setup, contact, faces);
  Vec6<float> diagonal{};
  for (int i = 0; i < 6; ++i) {
    diagonal[static_cast<std::size_t>(i)] = static_cast<float>(block.at(i, i));
  }
  return diagonal;
}

Vec6<float> solve_diagonal(const Node& node, Vec6<float> vector) {
  if (node.is_fixed) {
    return {};
  }
  const Triangle& factor = node.matrix.factor;
  for (int row = 0; row < 6; ++row) {
    float& value = vector[static_cast<std::size_t>(row)];
    for (int k = 0; k < row; ++k) {
      value -= factor[at(row, k)] * vector[static_cast<std::size_t>(k)];
    }
    value /= factor[at(row, row)];
  }
  for (int row = 5; row >= 0; --row) {
    float& value = vector[static_cast<std::size_t>(row)];
    for (int k = row + 1; k < 6; ++k) {
      value -= factor[at(k, row)] * vector[static_cast<std::size_t>(k)];
    }
    value /= factor[at(row, row)];
  }
  return vector;
}

Vec6<double> residual(const Node& node, const Setup& setup, const ContactSetting& contact) {
  Vec6<double> rest{};
  if (node.is_fixed) {
    return rest;
  }
  rest[2] = -setup.weight_n;
  Vec6<double> facet{};
  if (node.is_ground) {
    facet = mechanics::contact_force(contact.facet, node.state, node.is_held, node.u);
  }
  for (std::size_t i = 0; i < 6; ++i) {
    rest[i] -= node.force[i] + facet[i];
  }
  return rest;
}

mechanics::ContactState state_along(const Node& node, const ContactSetting& contact,
                                    const Vec6<float>& g, double t) {
  if (!node.is_ground) {
    return {.pressed = false};
  }
  return mechanics::contact_state(
      contact.facet, mechanics::trial_force(contact.facet, position_along(node, g, t)));
}

Vec6<double> facet_force_along(const Node& node, const ContactSetting& contact,
                               const Vec6<float>& g, double t) {
  if (!node.is_ground) {
    return {};
  }
  return mechanics::contact_force(contact.facet, state_along(node, contact, g, t), node.is_held,
                                  position_along(node, g, t));
}

double ratio_error(const Vec6<double>& residual, const Setup& setup,
                   const ContactSetting& contact) {
  double force = 0;
  double torque = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    force += absolute(static_cast<double>(residual[i]));
    torque += absolute(static_cast<double>(residual[i + 3]));
  }
  const double strength = setup.strength_vertical_n < setup.strength_lateral_n
                              ? setup.strength_vertical_n
                              : setup.strength_lateral_n;
  return (2 * (torque + force * contact.lever_mm) / setup.facet_mm + force) / strength;
}

}  // namespace holdfast::agent
