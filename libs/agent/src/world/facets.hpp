// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "algebra/tolerances.hpp"
#include "holdfast/agent/messages/order.hpp"
#include "holdfast/agent/world/node.hpp"
#include "holdfast/agent/world/surroundings.hpp"

/// The facets with which a node touches something: one on the floor, whose state is the node's, or,
/// where it has surroundings, any on its faces, each in a state and a frame of its own.
namespace holdfast::agent {

/// The surroundings of a node, or null: it can touch a floor only. `Foot`, here and below: a Node,
/// or a KeptNode of a root with fronts. (Small images need the hint `inline`.)
template <class Foot>
inline Surroundings* surroundings_of(const Foot& node) {
  return node.surroundings;
}

/// A facet that presses with less than this share of what else acts on it does not press: what is
/// left of the residual (kUnevenTolerance) may be as much. Elimination leaves less
/// (kEliminatedShare).
inline constexpr double kPressureTie = 1e-6;
inline constexpr double kPressureTieEliminated = kEliminatedShare * kPressureTie;

// The same as below, of a node with surroundings. `tie`: one of these.
namespace surrounded {
base::Vec6<double> facet_force(const Surroundings& node, const ContactSetting& contact,
                               const base::Vec6<double>& u);
base::Vec6<double> symmetric_product(const Surroundings& node, const ContactSetting& contact,
                                     const base::Vec6<double>& u);
bool look_up_states(Surroundings& node, const ContactSetting& contact, const base::Vec6<double>& u,
                    double tie);
void take_states(Surroundings& node);
base::Vec6<double> local_displacement(const Surroundings& node, const TouchingFacet& facet,
                                      const base::Vec6<double>& u);
bool hold_all_over(const Surroundings& node);
bool is_any_weak(const Surroundings& node, const ContactSetting& contact,
                 const base::Vec6<double>& u, double share);
bool is_all_bonded(const Surroundings& node);
void hold_facets(Surroundings& node, bool frees, Report& report);
void seek_facets(Surroundings& node, const ContactSetting& contact, const base::Vec6<double>& u,
                 const base::Cell& cell, const Order& order, Report& report);
void report_facets(const Surroundings& node, const ContactSetting& contact,
                   const base::Vec6<double>& u, const base::Cell& cell, Report& report);
}  // namespace surrounded

/// May a facet in this state have a second one under the regularised law, `u` in its own frame? As
/// the exact solver has it (solver/other_solutions.cpp): it is pulled sideways by more than it
/// presses, or than its gap would pull, and does not press all over.
inline bool is_doubtful(const ContactSetting& contact, const mechanics::ContactState& state,
                        const base::Vec6<double>& u) {
  if (contact.facet.law != mechanics::ContactLaw::kRegularised || state == mechanics::kStuck) {
    return false;
  }
  const base::Vec6<double> trial = mechanics::trial_force(contact.facet, u);
  return trial[0] * trial[0] + trial[1] * trial[1] > trial[2] * trial[2];
}

/// Does a facet tilt?
bool is_any_tilting(const Node& node);

/// Is a facet pulled sideways by more than its friction, or by so much that it cannot be told?
bool may_slip(const Node& node, const ContactSetting& contact);

/// The corners with which a node in a cell presses, in units of pitch over twice Environment's
/// foot_denominator, or over kCornerParts where it is no cube; what is bonded holds alone.
mechanics::SupportCorners support_corners(const Surroundings& node, const ContactSetting& contact,
                                          const base::Vec6<double>& u, const base::Cell& cell);

/// The force of the facets of a node on the ground for the displacement u, in the states in use;
/// linear in u.
template <class Foot>
inline base::Vec6<double> facet_force(const Foot& node, const ContactSetting& contact,
                                      const base::Vec6<double>& u) {
  const Surroundings* surroundings = surroundings_of(node);
  return surroundings != nullptr
             ? surrounded::facet_force(*surroundings, contact, u)
             : mechanics::contact_force(contact.facet, node.state, node.is_held, u);
}

/// What facets do to a displacement, by the symmetric stand-in of the tangent
/// (mechanics::symmetric_product).
inline base::Vec6<double> symmetric_facet_product(const Node& node, const ContactSetting& contact,
                                                  const base::Vec6<double>& u) {
  const Surroundings* surroundings = surroundings_of(node);
  return surroundings != nullptr
             ? surrounded::symmetric_product(*surroundings, contact, u)
             : mechanics::symmetric_product(contact.facet, node.state, node.is_held, u);
}

/// The tangent in use times u: the facets' own, or its stand-in.
inline base::Vec6<double> facet_product(const Node& node, const ContactSetting& contact,
                                        const base::Vec6<double>& u) {
  return contact.stands_in ? symmetric_facet_product(node, contact, u)
                           : facet_force(node, contact, u);
}

/// The facets' force at the node's place; with stand-ins that at the anchor, and from there on
/// theirs.
inline base::Vec6<double> facet_force_in_use(const Node& node, const ContactSetting& contact) {
  if (!contact.stands_in) {
    return facet_force(node, contact, node.u);
  }
  const auto anchor = base::converted<double>(node.anchor);
  return base::sum_of(facet_force(node, contact, anchor), 1.0,
                      facet_product(node, contact, base::sum_of(node.u, -1.0, anchor)));
}

/// The facets' tangent, of a node on the ground.
template <class Foot>
inline base::Mat6<double> facet_tangent(const Foot& node, const ContactSetting& contact) {
  const Surroundings* surroundings = surroundings_of(node);
  if (surroundings == nullptr) {
    return mechanics::contact_tangent(contact.facet, node.state, node.is_held);
  }
  return base::matrix_of<double>([&](const base::Vec6<double>& u) {
    return surrounded::facet_force(*surroundings, contact, u);
  });
}

/// The symmetric stand-in of the tangent.
inline base::Mat6<double> symmetric_facet_tangent(const Node& node, const ContactSetting& contact) {
  const Surroundings* surroundings = surroundings_of(node);
  if (surroundings == nullptr) {
    return mechanics::symmetric_tangent(contact.facet, node.state, node.is_held);
  }
  return base::matrix_of<double>([&](const base::Vec6<double>& u) {
    return surrounded::symmetric_product(*surroundings, contact, u);
  });
}

/// Calls visit(facet, index) for each facet of a node on the ground: 0 is its own on the floor, and
/// those of surroundings count from 1.
template <class Foot, class Visit>
void visit_facets(Foot& node, Visit&& visit) {
  Surroundings* surroundings = surroundings_of(node);
  if (surroundings == nullptr) {
    return visit(node, 0);
  }
  for (int i = 0; i < surroundings->facet_count; ++i) {
    visit(surroundings->facets[static_cast<std::size_t>(i)], i + 1);
  }
}

/// A displacement of the node in the frame of one of its facets.
template <class Foot>
base::Vec6<double> facet_displacement(const Foot& node, int index, const base::Vec6<double>& u) {
  const Surroundings* surroundings = surroundings_of(node);
  return surroundings == nullptr
             ? u
             : surrounded::local_displacement(
                   *surroundings, surroundings->facets[static_cast<std::size_t>(index - 1)], u);
}

/// Takes over the states that the law prescribes for a displacement. True: some are others.
template <class Foot>
bool follow_states_at(Foot& node, const ContactSetting& contact, const base::Vec6<double>& u) {
  if (Surroundings* surroundings = surroundings_of(node); surroundings != nullptr) {
    const bool has_changed =
        surrounded::look_up_states(*surroundings, contact, u, kPressureTieEliminated);
    surrounded::take_states(*surroundings);
    return has_changed;
  }
  const auto before = node.state;
  node.state = mechanics::contact_state(contact.facet, mechanics::trial_force(contact.facet, u));
  return !(node.state == before);
}

/// What a facet is tried in beside the state that was found.
inline mechanics::ContactState other_state(const mechanics::ContactState& found) {
  return {.pressed = !found.pressed};
}

/// Looks up the states that the law prescribes. True: some are not those in use.
inline bool look_up_states(Node& node, const ContactSetting& contact) {
  if (Surroundings* surroundings = surroundings_of(node); surroundings != nullptr) {
    return surrounded::look_up_states(*surroundings, contact, node.u, kPressureTie);
  }
  node.wanted = prescribed_state(node, contact);
  return node.is_ground && !(node.wanted == node.state);
}

/// The states that were looked up are in use from now on.
inline void take_states(Node& node) {
  node.state = node.wanted;
  if (Surroundings* surroundings = surroundings_of(node); surroundings != nullptr) {
    surrounded::take_states(*surroundings);
  }
}

/// Spreads cells and contact states over 32 bits, so that sums over the robot tell sets of states
/// apart.
std::uint32_t hash_of(const base::Cell& cell, int code);

/// One facet's part in a kHold; `Facet` is a node with its facet on the floor, or one of several.
template <class Facet>
void hold_facet(Facet& facet, bool frees, Report& report) {
  if (!facet.state.pressed && facet.is_held && (frees || !facet.was_released)) {
    facet.is_held = false;
    facet.was_released = true;
    ++report.count;
  } else if (facet.state.pressed && !facet.is_held && !frees) {
    facet.is_held = true;
    ++report.count;
  }
  report.number += !facet.state.pressed && facet.is_held ? 1U : 0U;
}

/// The key of a facet for a kSeek, not 0; the cell as seen from the root (from_root()).
inline std::uint32_t seek_key(const base::Cell& cell, int facet) {
  return hash_of(cell, facet) | 1U;
}

/// A kSeek's next key, if this one is behind the order's and before the one so far.
inline void offer_key(std::uint32_t key, const Order& order, Report& report) {
  ++report.count;
  const bool is_next = key > order.key() && (report.number == 0 || key < report.number);
  report.number = is_next ? key : report.number;
}

/// One facet's part in a kSeek; `index` among those of the module in the cell.
template <class Facet>
void seek_facet(Facet& facet, bool is_doubtful, const base::Cell& cell, int index,
                const Order& order, Report& report) {
  if ((order.flags & kRemember) != 0) {
    facet.found = facet.state;
    facet.is_doubtful = is_doubtful;
  }
  const std::uint32_t key = seek_key(cell, index);
  const bool is_tried = facet.is_doubtful && key == order.key();
  facet.state = is_tried ? other_state(facet.found) : facet.found;
  facet.wanted = facet.state;
  if (facet.is_doubtful) {
    offer_key(key, order, report);
  }
}

/// One facet's part in a kSeek with kOneFoot: each state in which the facet presses has a key.
template <class Facet>
void press_alone(Facet& facet, const base::Cell& cell, int index, const Order& order,
                 Report& report) {
  constexpr int kIndexMax = 16;
  facet.state = {.pressed = false};
  for (int code = 1; code < mechanics::ContactState::kCodeCount; ++code) {
    const std::uint32_t key = seek_key(cell, index + kIndexMax * code);
    facet.state = key == order.key() ? mechanics::ContactState::from_code(code) : facet.state;
    offer_key(key, order, report);
  }
  facet.wanted = facet.state;
}

/// One facet's part in a kSeek with kEachState, of keys that differ in their last four bits by the
/// state.
template <class Facet>
void take_given_state(Facet& facet, const base::Cell& cell, int index, const Order& order,
                      Report& report) {
  const std::uint32_t own = (hash_of(cell, index) | (kStateBits + 1)) & ~kStateBits;
  const std::uint32_t given = order.key() & ~kStateBits;
  const auto code = static_cast<int>(order.key() & kStateBits);
  if (own <= given) {
    facet.state = mechanics::ContactState::from_code(own == given ? code : 0);
  }
  facet.wanted = facet.state;
  facet.is_given = true;
  ++report.count;
  const bool is_next = own > given && (report.number == 0 || own < report.number);
  report.number = is_next ? own : report.number;
}

}  // namespace holdfast::agent
