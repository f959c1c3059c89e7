// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "holdfast/module/configuration.hpp"
#include "holdfast/module/relayed_port.hpp"
#include "holdfast/module/status_report.hpp"

namespace holdfast::module {

/// Takes a robot's configuration from whoever tells it at a face, and hands it on to the
/// neighbours, so that it is told to one module only.
///
/// A configuration has a revision; the later one holds (numbers count over), and of two with the
/// same number the one with the larger sum. A module without one, or with one that it was told,
/// says its revision to each neighbour until that has said the same. Meanwhile no packets pass, so
/// to the program that neighbour is silent: modules with different numbers never work out a verdict
/// together. Whoever hears of an older revision than its own sends its
/// own. A robot whose pages were flashed (revision 0) says nothing of all this.
class Configurer final : public RelayedPort {
 public:
  /// Keeps references; `configuration` need not be valid.
  Configurer(Port& port, Configuration& configuration);

  /// Has the module been told something since the last call? Then its configuration is another one
  /// now, kept by the port, and the program has to begin anew; false also if it is told who it is
  /// before it has a configuration.
  bool take_change();

  bool is_configured() const { return is_configured_; }

  bool receive(Incoming& incoming) override;
  void send(int face, std::span<const std::uint8_t> packet) override;
  void wait(Time until) override;

  /// The module learns who it is.
  void tell_who(const Who& who);

 private:
  static constexpr Time kSayEvery = 500'000;

  struct Face {
    bool is_agreed = false;
    bool says = false;   ///< Our revision has to be said.
    int next_part = -1;  ///< Of ours, to be sent; -1: none.
    Time asks_at = 0;
  };

  Revision own() const;
  bool is_older_than(const Revision& other) const;

  bool speaks() const { return !is_configured_ || configuration_.revision != 0; }

  void take_revision(Face& face, std::span<const std::uint8_t> payload);
  void take_part(Face& face, std::span<const std::uint8_t> payload);
  void take_whole();
  void adopt();
  void seal();
  bool serve(int at);
  void send_part(int at);

  Configuration& configuration_;
  bool is_configured_;
  bool has_changed_ = false;
  bool is_complete_ = false;  ///< A later setup is there, and not yet in the configuration.
  std::array<Face, base::kDirectionCount> faces_;
  Revision arriving_;
  std::uint32_t arrived_ = 0;  ///< Parts, by bit.
  agent::CubeSetup setup_;
};

}  // namespace holdfast::module
