// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "holdfast/agent/algebra/branch.hpp"
#include "holdfast/agent/cells/lattices.hpp"
#include "holdfast/agent/wire/round.hpp"
#include "holdfast/agent/wire/wire.hpp"
#include "holdfast/base/algebra.hpp"
#include "holdfast/base/cell.hpp"

/// All messages but orders and reports (order.hpp), as values. docs/wire.md says what they are for.
///
/// A checksum tells that a message is what the neighbour has sent, not that it makes sense. So
/// every number of a message that names one of several things, or a place in memory, is looked at
/// where it is read (codec.hpp): kinds, flags, indices, faces, cells, counts of exchanges.
/// Reals may be anything, what is not a number included: a method that diverges says so with them.
/// The limits are those of docs/wire.md. What may be said at a certain time only is the agent's to
/// know (Agent::expects).
namespace holdfast::agent {

/// Why no verdict is certain, whatever the loads are; the graver the larger.
enum class Doubt : std::uint8_t {
  kNone,
  kNeighbourSilent,
  kCellsContradict,  ///< A module was told two cells.
  kFacesMismatch,    ///< Two faces are connected that do not look at each other.
};

/// A wave on its way out: take part in a round, and where you are.
struct Join {
  Round round = {};
  std::uint8_t wave = 1;
  std::uint8_t stage = 0;  ///< Of a step that is judged in this round, or 0.
  base::Cell cell = {};    ///< Cell of the sender in the first wave, else of the wave's root.
  std::uint16_t hops =
      0;  ///< Hops of the sender; beyond kExtentMax stands for all that is further.
};

/// A wave on its way back: who is behind the sender.
struct Echo {
  Round round = {};
  std::uint8_t wave = 1;
  std::uint32_t count = 0;     ///< Modules from the sender down.
  std::uint16_t hops = 0;      ///< Hops of the furthest of them.
  std::uint32_t id = 0;        ///< Identity of that module; of several the lowest.
  Doubt doubt = Doubt::kNone;  ///< The gravest of theirs.
};

/// Who acts after a wave.
struct Appointment {
  std::uint8_t wave = 1;  ///< The one that has ended.
  std::uint32_t id = 0;
  std::uint16_t hops = 0;  ///< Half of that module's.
};

/// A mark on its way to the middle.
struct Mark {
  std::uint16_t hops = 0;  ///< Still to go.
  base::Cell sender = {};  ///< Cell of the module that sent it first.
};

/// Tells a neighbour that has come after a verdict its place in the tree that stands. What moves it
/// follows as six reals, `vector`.
struct Adoption {
  Round round = {};
  base::Cell sender = {};
  base::Cell root = {};
  std::uint16_t hops = 0;       ///< Of the sender.
  std::uint32_t wave_time = 0;  ///< How long the waves took (watch.hpp).
  float load_ratio = 0;         ///< Of the connection, if it was planned.
};

/// What has changed after a verdict.
struct News {
  std::uint8_t flags = 0;  ///< kIsFulfilled, kIsEnded, kIsGrown; none: a cell is planned.
  std::uint16_t hops = 0;  ///< With kIsGrown: of the module that has come.
  base::Cell cell = {};
};

/// Bits in the label of `planned down`: the index, and for an iteration which part of a
/// displacement it is.
inline constexpr std::uint8_t kPlannedIndexMask = 0x3f;
inline constexpr std::uint8_t kLeadingPart = 0x40;
inline constexpr std::uint8_t kTrailingPart = 0x80;

/// The last label of `reach`: those below are parts of a LoadWay, this is what is outside of a
/// subtree.
inline constexpr std::uint8_t kReachLabelLast = 6;

/// Six reals and what they are: an exchange's tag, a planned index, a column, a loop.
struct LabelledVector {
  wire::MessageType type = wire::MessageType::kVector;
  std::uint8_t label = 0;
  base::Vec6<float> vector = {};
};

/// `message` is whole, as Link::next_message() gives it. False: no program of this version writes
/// it.
bool is_legal(std::span<const std::uint8_t> message, int face_count = kOwnFaceCount);

wire::Writer encode(const Join& join);
wire::Writer encode(const Echo& echo);
wire::Writer encode(const Appointment& appointment);
wire::Writer encode(const Mark& mark);
wire::Writer encode(const Cut& cut);
wire::Writer encode(const Adoption& adoption);
wire::Writer encode(const News& news);
wire::Writer encode(const LabelledVector& labelled);

/// Reads a message of this type. False: no program of this version writes it.
bool decode(std::span<const std::uint8_t> message, Join& join);
bool decode(std::span<const std::uint8_t> message, Echo& echo);
bool decode(std::span<const std::uint8_t> message, Appointment& appointment);
bool decode(std::span<const std::uint8_t> message, Mark& mark);
bool decode(std::span<const std::uint8_t> message, Cut& cut);
bool decode(std::span<const std::uint8_t> message, Adoption& adoption);
bool decode(std::span<const std::uint8_t> message, News& news);
bool decode(std::span<const std::uint8_t> message, LabelledVector& labelled);

inline wire::Writer vector_message(wire::MessageType type, std::uint8_t label,
                                   const base::Vec6<float>& vector) {
  return encode(LabelledVector{.type = type, .label = label, .vector = vector});
}

/// A part of the occupied cells (occupied_cells.hpp): its index and its bits.
wire::Writer part_message(wire::MessageType type, std::uint8_t index,
                          std::span<const std::uint8_t> bits);

/// A message that is legal, as a value.
template <class Message>
Message decoded(std::span<const std::uint8_t> message) {
  Message value;
  decode(message, value);
  return value;
}

}  // namespace holdfast::agent
