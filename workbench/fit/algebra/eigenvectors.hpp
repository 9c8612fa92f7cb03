// The greatest eigenvalues of a symmetric matrix, and their eigenvectors.
// Takes: the matrix, of which the lower triangle counts, and how many. Gives: them, greatest first.
// Keeps true: where few are asked for, the others' vectors are not computed; vectors are orthogonal
// to rounding, those of equal eigenvalues too. Source: Golub, Van Loan, "Matrix Computations", 8.3
// and 8.4: tridiagonal form, its eigenvalues, inverse iteration.
#pragma once

#include "fit/algebra/affine.hpp"

namespace etlc::fit {

struct Eigenpairs {
    Vector values;
    Matrix vectors;  ///< as columns
};
Eigenpairs greatest_eigenpairs(const Matrix& symmetric, Eigen::Index count);

}  // namespace etlc::fit
