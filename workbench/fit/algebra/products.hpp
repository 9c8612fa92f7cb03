// Sums of outer products: where fitting spends its time.
// Takes: vectors, as columns. Gives: the lower triangle of factor * the sum of their outer
// products. Keeps true: every element is summed in the order of the columns, each product rounded
// before it is added, so machines with wider vectors give the same bits.
#pragma once

#include "fit/algebra/affine.hpp"

namespace etlc::fit {

/// lower += factor * columns * columns^T, lower triangle alone; above it anything may be written.
void add_products(const Eigen::Ref<const Matrix>& columns, double factor, Eigen::Ref<Matrix> lower);

}  // namespace etlc::fit
