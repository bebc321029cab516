// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Small dense problems: the coarsest level and small components. Internal: names Eigen types.
#pragma once

#include <Eigen/Core>

#include "numerics/bordered_matrix.h"

namespace eigencrust {

Eigen::MatrixXd to_dense(const BorderedMatrix& matrix);

/// Eigenvector of the smallest eigenvalue of M x = λ D x, scaled to xᵀ D x = 1; rows without mass get 0.
/// \return the eigenvalue
double smallest_eigenvector_dense(const BorderedMatrix& matrix, const Vector& mass, Vector& x);

} // namespace eigencrust
