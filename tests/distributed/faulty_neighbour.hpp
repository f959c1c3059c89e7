// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "holdfast/base/rng.hpp"
#include "holdfast/sim/simulation.hpp"

/// A module whose program fails while its links go on to work: what it sends is changed on its way
/// to the line, with the right checksums and sequence numbers (docs/wire.md).
namespace holdfast::test {

struct FaultyOptions {
  enum class Kind : std::uint8_t {
    kHangs,  ///< From `at` on it acknowledges everything and says nothing.
    kLies,   ///< From `at` on one message in `one_in` is changed, lost, doubled or another one.
  };

  Kind kind = Kind::kHangs;
  std::int32_t module = 0;
  sim::Time at = 0;
  std::uint64_t one_in = 20;
  std::uint64_t seed = 1;
};

class FaultyNeighbour {
 public:
  FaultyNeighbour(const model::Robot& robot, const FaultyOptions& options);

  /// Changes packets as a sim::Tamper.
  int tamper(sim::Time now, std::int32_t module, base::Direction face,
             std::span<std::uint8_t> packet, int size);

  /// Messages that were not sent as the program wanted.
  int change_count() const { return change_count_; }

 private:
  using Bytes = std::vector<std::uint8_t>;

  /// A data packet, to be sent again in the same way.
  struct Sent {
    Bytes original;
    Bytes changed;
  };

  /// The stream that goes out on one face of a module.
  struct Stream {
    std::uint16_t number = 0;  ///< Of the session, as the module greets.
    Bytes message;             ///< Begun and not yet complete.
    std::array<Sent, 64> sent;
  };

  Stream& stream(std::int32_t module, base::Direction face);
  Bytes change(sim::Time now, Stream& out, std::span<const std::uint8_t> payload, std::size_t room);
  void add_changed(Bytes& payload, Bytes message);
  void spoil(Bytes& message);
  Bytes random_message();

  const model::Robot& robot_;
  FaultyOptions options_;
  base::Rng rng_;
  std::vector<Stream> streams_;
  int change_count_ = 0;
};

}  // namespace holdfast::test
