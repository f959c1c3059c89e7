// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "holdfast/base/result.hpp"
#include "holdfast/solver/contact_journal.hpp"
#include "ranks/petsc_ranks.hpp"
#include "ranks/shared_text.hpp"

namespace holdfast::cluster {

/// A file with the contact states that the searches of a run have come to, of all ranks, written
/// anew whole after every step (docs/formats.md). A later run of the same structure, on as many
/// ranks as it likes, goes on from there.
class Checkpoint final : public solver::ContactJournal {
 public:
  /// The structure has this fingerprint, and `facet_count` of its facets are this rank's.
  Checkpoint(PetscRanks& ranks, std::string file, std::uint64_t fingerprint,
             std::size_t facet_count);

  /// Takes what the file has of an earlier run; nothing if there is no file. Errors, the same at
  /// all ranks: the file is damaged, or of another structure.
  std::optional<base::Error> read();

  std::vector<std::uint8_t> begin(mechanics::ContactLaw law, double gamma) override;

  /// Throws std::runtime_error if the file cannot be written.
  void keep(std::span<const std::uint8_t> states) override;

  /// Removes the file, to be called when there is an answer.
  void remove() const;

 private:
  /// One search, and the latest states of all ranks' facets along its curve; none at first.
  struct Search {
    mechanics::ContactLaw law = mechanics::ContactLaw::kRegularised;
    double gamma = 0;
    std::vector<std::uint8_t> states;
  };

  std::optional<base::Error> take(const std::string& bytes);
  std::string bytes() const;

  PetscRanks& ranks_;
  std::string file_;
  std::uint64_t fingerprint_;
  std::size_t facet_count_;          ///< Of this rank.
  std::size_t facet_begin_;          ///< Where they begin among all ranks'.
  std::size_t facet_count_all_ = 0;  ///< Of all ranks.
  std::vector<Search> earlier_;      ///< Of the run that was ended.
  std::vector<Search> searches_;     ///< Of this run, the last one at present.
};

}  // namespace holdfast::cluster
