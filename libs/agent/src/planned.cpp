// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/planned.hpp"

#include "holdfast/agent/more_faces.hpp"

namespace holdfast::agent {

using base::Direction;

#ifndef HOLDFAST_AGENT_FLOOR_ONLY
Directions Planned::directions() const { return agent::directions(more_); }
#endif

void Planned::clear() {
  MoreFaces* lent = more();
  *this = Planned();
  lend(lent);
  if (lent != nullptr) {
    lent->below = {};
  }
}

Faces Planned::below(Direction child, int index) const {
  const auto face = static_cast<std::size_t>(child);
  if (const MoreFaces* lent = more(); kKnowsLattices && lent != nullptr) {
    return lent->below[face][at(index)];
  }
  return Faces::from_mask(below_[face][at(index)].mask());
}

void Planned::set_below(Direction child, int index, Faces touching) {
  const auto face = static_cast<std::size_t>(child);
  if (MoreFaces* lent = more(); kKnowsLattices && lent != nullptr) {
    lent->below[face][at(index)] = touching;
  } else {
    below_[face][at(index)] = base::Faces::from_mask(static_cast<std::uint8_t>(touching.mask()));
  }
}

void Planned::add(const base::Cell& cell, const base::Cell& self) {
  if (count_ == kPlannedMax) {
    return;
  }
  forget_hosts();
  const std::size_t i = count_++;
  cells_[i] = cell;
  own_touching_[i] = {};
  for (const Direction face : directions()) {
    if (neighbour(more(), self, face) == cell) {
      own_touching_[i] = Faces::only(base::opposite(face));
    }
  }
}

int Planned::find(const base::Cell& cell) const {
  for (int k = 0; k < count_; ++k) {
    if (cells_[at(k)] == cell) {
      return k;
    }
  }
  return -1;
}

void Planned::remove(int index) {
  forget_hosts();
  --count_;
  for (int k = index; k < count_; ++k) {
    cells_[at(k)] = cells_[at(k + 1)];
    own_touching_[at(k)] = own_touching_[at(k + 1)];
    for (const Direction child : directions()) {
      set_below(child, k, below(child, k + 1));
    }
  }
  own_touching_[at(count_)] = {};
  for (const Direction child : directions()) {
    set_below(child, count_, {});
  }
}

void Planned::forget_hosts() {
  hosted_count_ = 0;
  from_above_ = {};
  involved_ = {};
  is_any_remote_ = false;
}

void Planned::add_below(Direction child, int index, Faces touching) {
  if (index < count_) {
    set_below(child, index, touching);
  }
}

Faces Planned::touching(int index) const {
  Faces faces = own_touching(index);
  for (const Direction child : directions()) {
    faces |= below(child, index);
  }
  return faces;
}

/// Are all participants of a group from this module down?
bool Planned::is_whole(std::uint8_t group) const {
  for (int k = 0; k < count_; ++k) {
    if (group_of(k) == group && touching(k) != total(k)) {
      return false;
    }
  }
  return true;
}

/// Are all participants of a group below a child? Of one that touches nothing they are.
bool Planned::is_whole_below(std::uint8_t group, Direction child) const {
  for (int k = 0; k < count_; ++k) {
    if (group_of(k) == group && below(child, k) != total(k)) {
      return false;
    }
  }
  return true;
}

/// Is any participant of a group below a child?
bool Planned::is_any_below(std::uint8_t group, Direction child) const {
  for (int k = 0; k < count_; ++k) {
    if (group_of(k) == group && !below(child, k).is_empty()) {
      return true;
    }
  }
  return false;
}

void Planned::decide_hosts(const PlannedMasks& totals) {
  forget_hosts();
  for (int k = 0; k < count_; ++k) {
    totals_[at(k)] = Faces::from_mask(totals[at(k)]);
    groups_[at(k)] = static_cast<std::uint8_t>(k);
  }
  // A group is named after its first module; names spread until nothing changes.
  for (int pass = 0; pass < count_; ++pass) {
    for (int k = 0; k < count_; ++k) {
      for (const Direction direction : directions()) {
        const int other = neighbour_of(k, direction);
        if (other >= 0 && group_of(other) < group_of(k)) {
          groups_[at(k)] = group_of(other);
        }
      }
    }
  }
  for (int k = 0; k < count_; ++k) {
    const std::uint8_t group = group_of(k);
    // What touches nothing is whole below every face, so nobody hosts it.
    bool is_above = false;
    bool is_own_only = true;
    for (const Direction child : directions()) {
      is_above = is_above || is_whole_below(group, child);
      is_own_only = is_own_only && !is_any_below(group, child);
    }
    if (is_above) {
      continue;
    }
    if (is_whole(group)) {
      hosted_[hosted_count_++] = static_cast<std::uint8_t>(k);
      involved_.add(k);
      is_any_remote_ = is_any_remote_ || !is_own_only;
    } else if (!touching(k).is_empty()) {
      from_above_.add(k);
      involved_.add(k);
      is_any_remote_ = true;
    }
  }
}

bool Planned::agrees_with(const PlannedMasks& totals) const {
  for (int k = 0; k < count_; ++k) {
    if (!(touching(k) - Faces::from_mask(totals[at(k)])).is_empty()) {
      return false;
    }
  }
  return true;
}

int Planned::at_face(Direction face) const {
  for (int k = 0; k < count_; ++k) {
    if (own_face(k).has(face)) {
      return k;
    }
  }
  return -1;
}

int Planned::neighbour_of(int index, Direction direction) const {
  const base::Cell wanted = neighbour(more(), cell(index), direction);
  for (int k = 0; k < count_; ++k) {
    if (cell(k) == wanted) {
      return k;
    }
  }
  return -1;
}

int Planned::node_of(int index) const {
  for (int i = 0; i < hosted_count_; ++i) {
    if (hosted(i) == index) {
      return 1 + i;
    }
  }
  return -1;
}

int Planned::slot_of(int index) const {
  const int node = node_of(index);
  if (node >= 0) {
    return node;
  }
  int slot = 1 + hosted_count_;
  for (int k = 0; k < index; ++k) {
    slot += is_from_above(k) ? 1 : 0;
  }
  return slot;
}

bool Planned::is_needed_below(Direction child, int index) const {
  return involved_.has(index) && !below(child, index).is_empty();
}

}  // namespace holdfast::agent
