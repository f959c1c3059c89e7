// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "holdfast/certificate/certificate.hpp"
#include "holdfast/verdict/assessment.hpp"

/// Makes certificates of what connections carry: refines the displacements of an assessment until
/// the certificate's own checker is content. docs/proof.md says what is proved, and how.
namespace holdfast::proof {

struct ProofOptions {
  std::size_t memory_bytes_max = solver::EquilibriumOptions{}.memory_bytes_max;
  int thread_count = 0;  ///< 0: all cores.
};

struct Proof {
  certificate::Certificate certificate;          ///< Without modules if there is nothing to check.
  certificate::Verification verification{};      ///< What its checker says.
  int solve_count = 0;                           ///< Linear systems solved for it.
  std::vector<base::Vec6<double>> displacement;  ///< The certificate's, mm and rad.
  std::vector<base::Vec6<double>> displacement_low;  ///< To be added to it for 106 bits.

  bool is_proved() const { return verification.is_proved; }
};

/// Proves the largest load ratio of a robot that stands and whose equilibrium was found, in the
/// contact states that were found.
Proof prove(const model::Robot& robot, const verdict::Assessment& assessment,
            const ProofOptions& options = {});

/// Takes the proof over into the assessment: its loads are then the certificate's, its verdict is
/// what the range says, and `undecided` where nothing is proved or other solutions do not agree. A
/// robot that topples is known to from integers alone. 0 threads: all cores.
void apply(const model::Robot& robot, const Proof& proof, verdict::Assessment& assessment,
           int thread_count = 0);

}  // namespace holdfast::proof
