// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/world/node.hpp"

#include "algebra/scalar.hpp"
#include "world/facets.hpp"

namespace holdfast::agent {
namespace {

using base::Vec6;

std::size_t at(int row, int column) {
  return static_cast<std::size_t>(row * (row + 1) / 2 + column);
}

/// The forces of all beams on `faces` for a displacement of the node alone.
Vec6<double> beam_forces(const Setup& setup, Faces faces, const Vec6<double>& u) {
  Vec6<double> force{};
  for (const base::Direction direction : faces) {
    base::add_to(force, end_force(setup.beams(), direction, u, Vec6<double>{}));
  }
  return force;
}

}  // namespace

void prepare(Setup& setup) {
  setup.beam = mechanics::beam_stiffness(setup.section);
  const mechanics::BeamSection<double>& section = setup.section;
  const mechanics::BeamSection<float> single = {
      .elastic_modulus = static_cast<float>(section.elastic_modulus),
      .length = static_cast<float>(section.length),
      .area = static_cast<float>(section.area),
      .moment_x = static_cast<float>(section.moment_x),
      .moment_y = static_cast<float>(section.moment_y),
      .torsion = static_cast<float>(section.torsion)};
  setup.beam_float = mechanics::beam_stiffness(single);
  setup.prepare(section, single);
}

void reset(Node& node) {
  node.is_held = true;
  node.was_released = false;
  node.is_kept = false;
  node.state = {.pressed = node.is_ground};
  node.wanted = node.state;
  node.u = {};
  node.anchor = {};
  node.force = {};
  if (Surroundings* surroundings = surroundings_of(node); surroundings != nullptr) {
    reset(*surroundings);
  }
}

Vec6<double> load_of(const Node& node, const Setup& setup) {
  const Surroundings* surroundings = surroundings_of(node);
  return surroundings != nullptr ? surroundings->load : Vec6<double>{0, 0, -setup.weight_n};
}

void form_diagonal(Node& node, const Setup& setup, const ContactSetting& contact, Faces faces,
                   int half) {
  for (int column = 3 * half; column < 3 * half + 3; ++column) {
    const auto unit = base::unit<double>(column);
    Vec6<double> image = beam_forces(setup, faces, unit);
    if (node.is_ground) {
      base::add_to(image, symmetric_facet_product(node, contact, unit));
    }
    for (int row = column; row < 6; ++row) {
      node.matrix.factor[at(row, column)] =
          static_cast<float>(image[static_cast<std::size_t>(row)]);
    }
  }
}

void factor_diagonal(Node& node, int half) {
  Triangle& factor = node.matrix.factor;
  for (int row = 3 * half; row < 3 * half + 3; ++row) {
    for (int column = 0; column <= row; ++column) {
      float sum = factor[at(row, column)];
      for (int k = 0; k < column; ++k) {
        sum -= factor[at(row, k)] * factor[at(column, k)];
      }
      factor[at(row, column)] = row == column ? square_root(sum) : sum / factor[at(column, column)];
    }
  }
}

Vec6<double> diagonal_column(const Node& node, const Setup& setup, const ContactSetting& contact,
                             Faces faces, int column) {
  const auto unit = base::unit<double>(column);
  Vec6<double> image = beam_forces(setup, faces, unit);
  if (node.is_ground) {
    base::add_to(image, facet_product(node, contact, unit));
  }
  return image;
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
  rest = load_of(node, setup);
  Vec6<double> facet{};
  if (node.is_ground) {
    facet = facet_force_in_use(node, contact);
  }
  for (std::size_t i = 0; i < 6; ++i) {
    rest[i] -= node.force[i] + facet[i];
  }
  return rest;
}

mechanics::ContactState prescribed_state(const Node& node, const ContactSetting& contact) {
  if (!node.is_ground) {
    return {.pressed = false};
  }
  return mechanics::contact_state(contact.facet, mechanics::trial_force(contact.facet, node.u));
}

double ratio_error(const Vec6<double>& residual, const Setup& setup,
                   const ContactSetting& contact) {
  double force = 0;
  double torque = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    force += absolute(static_cast<double>(residual[i]));
    torque += absolute(static_cast<double>(residual[i + 3]));
  }
  if (setup.ratio_per_n > 0) {
    return setup.ratio_per_n * force + setup.ratio_per_nmm * (torque + force * contact.lever_mm);
  }
  const double strength = setup.strength_vertical_n < setup.strength_lateral_n
                              ? setup.strength_vertical_n
                              : setup.strength_lateral_n;
  return (2 * (torque + force * contact.lever_mm) / setup.facet_mm + force) / strength;
}

}  // namespace holdfast::agent
