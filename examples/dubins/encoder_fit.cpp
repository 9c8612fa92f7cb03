// Separate from the rest of the encoder, because only dubins_prepare fits one, and Eigen's
// eigenvectors compile slowly.
#include <Eigen/Eigenvalues>

#include "encoder.hpp"

namespace demo {

Encoder Encoder::fit(const std::vector<Image>& images) {
    Eigen::MatrixXf rows(static_cast<Eigen::Index>(images.size()), blurred(images[0]).size());
    for (std::size_t i = 0; i < images.size(); ++i)
        rows.row(static_cast<Eigen::Index>(i)) = blurred(images[i]);

    Encoder encoder;
    encoder.mean_ = rows.colwise().mean();
    rows.rowwise() -= encoder.mean_.transpose();
    const Eigen::MatrixXd covariance =
        (rows.transpose() * rows).cast<double>() / static_cast<double>(images.size());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);  // eigenvalues are in
                                                                              // ascending order
    encoder.components_ =
        solver.eigenvectors().rightCols(kDimension).rowwise().reverse().transpose().cast<float>();
    encoder.kept_ = solver.eigenvalues().tail(kDimension).sum() / solver.eigenvalues().sum();
    return encoder;
}

}  // namespace demo
