// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "holdfast/module/configuration.hpp"
#include "holdfast/module/module.hpp"
#include "holdfast/module/relayed_port.hpp"
#include "holdfast/module/status_report.hpp"

namespace holdfast::module {

/// Answers whoever asks at a face how the module is, and keeps a log of what has happened to it.
///
/// It sends nothing unless it is asked, and only at the face at which it was asked, so a robot
/// without an instrument sends the same bytes. It looks at the module once in each turn: of two
/// phases within one turn the log has the later one.
class Instrument final : public RelayedPort {
 public:
  /// Keeps references. What is in the configuration may change.
  Instrument(Port& port, const Configuration& configuration);

  /// Makes it speak of this module from now on; null: there is none yet, for want of a
  /// configuration.
  void speak_of(const Module* module);

  bool receive(Incoming& incoming) override;
  void wait(Time until) override;

  StatusReport report();

 private:
  /// How much is kept of what has happened. More is a larger HF_BYTES.
  static constexpr std::uint16_t kLogCount = 16;

  void log(LogEntry::What what, std::uint8_t value, std::uint16_t number = 0,
           const base::Cell& cell = {});
  void log_other_version(const Incoming& packet);
  void log_plan(std::span<const std::uint8_t> payload);
  void note();
  void note_neighbours();
  void answer(int face);
  void tell_log(int face);

  const Configuration& configuration_;
  const Module* module_ = nullptr;
  Status last_;
  std::uint8_t connected_ = 0;
  std::uint8_t others_ = 0;  ///< Faces whose neighbours' packets are of another version, by bit.
  std::array<std::uint8_t, base::kDirectionCount> asked_{};  ///< Ask::what, by face.
  std::uint16_t log_from_ = 0;                               ///< What the last one who asked wants.
  std::uint16_t log_next_ = 0;
  std::array<LogEntry, kLogCount> log_;
};

}  // namespace holdfast::module
