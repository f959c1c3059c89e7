// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/planned.hpp"

namespace holdfast::agent {

using base::Direction;
using base::Faces;

void Planned::add(const base::Cell& cell, const base::Cell& self) {
  if (count_ == kPlannedMax) {
    return;
  }
  forget_hosts();
  const std::size_t i = count_++;
  cells_[i] = cell;
  own_touching_[i] = {};
  for (const Direction face : base::kDirections) {
    if (base::neighbour(self, face) == cell) {
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
    for (auto& child : below_) {
      child[at(k)] = child[at(k + 1)];
    }
  }
  own_touching_[at(count_)] = {};
  for (auto& child : below_) {
    child[at(count_)] = {};
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
    below_[static_cast<std::size_t>(child)][at(index)] = touching;
  }
}

Faces Planned::touching(int index) const {
  Faces faces = own_touching(index);
  for (const auto& child : below_) {
    faces |= child[at(index)];
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
    if (group_of(k) == group && below_[static_cast<std::size_t>(child)][at(k)] != total(k)) {
      return false;
    }
  }
  return true;
}

/// Is any participant of a group below a child?
bool Planned::is_any_below(std::uint8_t group, Direction child) const {
  for (int k = 0; k < count_; ++k) {
    if (group_of(k) == group && !below_[static_cast<std::size_t>(child)][at(k)].is_empty()) {
      return true;
    }
  }
  return false;
}

void Planned::decide_hosts(const std::array<std::uint8_t, 8>& totals) {
  forget_hosts();
  for (int k = 0; k < count_; ++k) {
    totals_[at(k)] = Faces::from_mask(totals[at(k)]);
    groups_[at(k)] = static_cast<std::uint8_t>(k);
  }
  // A group is named after its first module; names spread until nothing changes.
  for (int pass = 0; pass < count_; ++pass) {
    for (int k = 0; k < count_; ++k) {
      for (const Direction direction : base::kDirections) {
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
    for (const Direction child : base::kDirections) {
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

bool Planned::agrees_with(const std::array<std::uint8_t, 8>& totals) const {
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
  const base::Cell wanted = base::neighbour(cell(index), direction);
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
  return involved_.has(index) && !below_[static_cast<std::size_t>(child)][at(index)].is_empty();
}

}  // namespace holdfast::agent
