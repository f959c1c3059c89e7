// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How far a conjugate-gradient iterate is from the solution, from two numbers an iteration.
///
/// With residuals r_k, rho_k = (r_k, M^-1 r_k), lengths alpha_k and directions
/// p_k = M^-1 r_k + beta_k p_k-1, beta_k = rho_k / rho_k-1, the error e of the iterate has
///   e K e <= phi_k rho_k / lambda,     phi_k = rho_k / (p_k, M p_k)                     (1)
/// with the least eigenvalue lambda of M^-1 K [Meurant, Tichy 2019]. phi follows a
/// recurrence and makes up for residuals that grow while the error falls.
///
/// lambda is that of the tridiagonal matrix of the process, T = L L^t with L bidiagonal:
/// L_kk = alpha_k^-1/2, L_k,k-1 = (beta_k / alpha_k-1)^1/2. ||L^-1||^2 = 1 / lambda is estimated as
/// L grows, from the best vector in the plane of the last best one and the new unit vector [Duff,
/// Voemel 2002]. It is never less than the true lambda and in practice within some percent of T's,
/// but T itself may not have met the slowest mode yet: an estimate, no guarantee.
namespace holdfast::agent {

class EnergyBound {
 public:
  void restart() { is_first_ = true; }

  /// An iteration of length `alpha` from a residual with `rho`, both positive. Returns the bound on
  /// e K e of the iterate before it; after it e K e is less by alpha rho.
  double add(double rho, double alpha);

  /// The least eigenvalue of M^-1 K that has shown so far.
  double eigenvalue() const { return 1 / inverse_; }

 private:
  bool is_first_ = true;
  double rho_ = 0;      ///< rho of the iteration before, ...
  double alpha_ = 0;    ///< ... and its length.
  double phi_ = 1;      ///< Eq. (1)
  double inverse_ = 0;  ///< ||L^-1||^2, by the vector x
  double last_ = 0;     ///< |L^-t e_k|^2 with the last unit vector e_k
  double mixed_ = 0;    ///< (L^-t x, L^-t e_k)
};

}  // namespace holdfast::agent
