// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/groups/planned.hpp"

#include "holdfast/agent/groups/more_planned.hpp"
#include "holdfast/agent/links/more_faces.hpp"
#include "holdfast/agent/world/lent_memory.hpp"

namespace holdfast::agent {

using base::Direction;

base::DirectionRange Planned::directions() const { return agent::directions(more()); }

void Planned::clear() {
  const LentMemory* lent = lent_;
  *this = Planned();
  lend(lent);
  if (more() != nullptr) {
    more()->below = {};
  }
  if (more_planned() != nullptr) {
    more_planned()->below = {};
  }
}

template <class T>
T& Planned::place(ByPlanned<T>& own, ByMorePlanned<T> MorePlanned::*lent, int index) {
  return is_own(index) ? own[at(index)] : (more_planned()->*lent)[at(index - kPlannedMax)];
}

template <class T>
const T& Planned::place(const ByPlanned<T>& own, ByMorePlanned<T> MorePlanned::*lent,
                        int index) const {
  return is_own(index) ? own[at(index)] : (more_planned()->*lent)[at(index - kPlannedMax)];
}

const base::Cell& Planned::more_cell(int index) const {
  return place(cells_, &MorePlanned::cells, index);
}

Faces Planned::more_own_touching(int index) const {
  return place(own_touching_, &MorePlanned::own_touching, index);
}

Faces Planned::more_total(int index) const { return place(totals_, &MorePlanned::totals, index); }

int Planned::more_hosted(int i) const { return place(hosted_, &MorePlanned::hosted, i); }

std::uint8_t Planned::group_of(int index) const {
  return place(groups_, &MorePlanned::groups, index);
}

Faces Planned::below(Direction child, int index) const {
  const auto face = static_cast<std::size_t>(child);
  if (!is_own(index)) {
    return more_planned()->below[face][at(index - kPlannedMax)];
  }
  if (const MoreFaces* lent = more(); lent != nullptr) {
    return lent->below[face][at(index)];
  }
  return Faces::from_mask(below_[face][at(index)].mask());
}

void Planned::set_below(Direction child, int index, Faces touching) {
  const auto face = static_cast<std::size_t>(child);
  if (!is_own(index)) {
    more_planned()->below[face][at(index - kPlannedMax)] = touching;
  } else if (MoreFaces* lent = more(); lent != nullptr) {
    lent->below[face][at(index)] = touching;
  } else {
    below_[face][at(index)] = base::Faces::from_mask(static_cast<std::uint8_t>(touching.mask()));
  }
}

void Planned::add(const base::Cell& cell, const base::Cell& self) {
  if (count_ == capacity()) {
    return;
  }
  forget_hosts();
  const int i = count_++;
  parts_here_ = 0;
  place(cells_, &MorePlanned::cells, i) = cell;
  Faces& touching = place(own_touching_, &MorePlanned::own_touching, i);
  touching = {};
  for (const Direction face : directions()) {
    if (neighbour(more(), self, face) == cell) {
      touching = Faces::only(base::opposite(face));
    }
  }
}

int Planned::find(const base::Cell& cell) const {
  for (int k = 0; k < count_; ++k) {
    if (this->cell(k) == cell) {
      return k;
    }
  }
  return -1;
}

void Planned::remove(int index) {
  forget_hosts();
  --count_;
  for (int k = index; k < count_; ++k) {
    place(cells_, &MorePlanned::cells, k) = cell(k + 1);
    place(own_touching_, &MorePlanned::own_touching, k) = own_touching(k + 1);
    for (const Direction child : directions()) {
      set_below(child, k, below(child, k + 1));
    }
  }
  place(own_touching_, &MorePlanned::own_touching, count_) = {};
  for (const Direction child : directions()) {
    set_below(child, count_, {});
  }
}

void Planned::forget_hosts() {
  hosted_count_ = 0;
  from_above_ = {};
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

void Planned::decide_hosts(const PlannedMasks& totals, int part) {
  forget_hosts();
  const int first = kIsGeneral ? part * kMasksOfPart : 0;
  for (int k = first; k < count_ && k < first + kMasksOfPart; ++k) {
    place(totals_, &MorePlanned::totals, k) = Faces::from_mask(totals[at(k - first)]);
  }
  if (part_count() > 1) {
    parts_here_ = static_cast<std::uint8_t>(part + 1);
    if (!has_all_parts()) {
      return;
    }
  }
  for (int k = 0; k < count_; ++k) {
    place(groups_, &MorePlanned::groups, k) = static_cast<std::uint8_t>(k);
  }
  // A group is named after its first module; names spread until nothing changes.
  for (int pass = 0; pass < count_; ++pass) {
    for (int k = 0; k < count_; ++k) {
      for (const Direction direction : directions()) {
        const int other = neighbour_of(k, direction);
        if (other >= 0 && group_of(other) < group_of(k)) {
          place(groups_, &MorePlanned::groups, k) = group_of(other);
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
      place(hosted_, &MorePlanned::hosted, hosted_count_++) = static_cast<std::uint8_t>(k);
      is_any_remote_ = is_any_remote_ || !is_own_only;
    } else if (!touching(k).is_empty()) {
      from_above_.add(k);
      is_any_remote_ = true;
    }
  }
}

bool Planned::agrees_with(const PlannedMasks& totals, int part) const {
  const int first = kIsGeneral ? part * kMasksOfPart : 0;
  for (int k = first; k < count_ && k < first + kMasksOfPart; ++k) {
    if (!(touching(k) - Faces::from_mask(totals[at(k - first)])).is_empty()) {
      return false;
    }
  }
  return true;
}

bool Planned::is_any_detached() const {
  PlannedSet held;
  for (int pass = 0; pass < count(); ++pass) {
    for (int k = 0; k < count(); ++k) {
      bool is_held = !touching(k).is_empty();
      for (const base::Direction direction : directions()) {
        const int other = neighbour_of(k, direction);
        is_held = is_held || (other >= 0 && held.has(other));
      }
      if (is_held) {
        held.add(k);
      }
    }
  }
  return held.bits() != (1U << static_cast<unsigned>(count())) - 1;
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
  return (is_from_above(index) || node_of(index) > 0) && !below(child, index).is_empty();
}

}  // namespace holdfast::agent
