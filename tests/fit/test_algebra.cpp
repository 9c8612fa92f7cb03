// Compares the algebra of fitting with its definitions, written out plainly.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "fit/algebra/clusters.hpp"
#include "fit/algebra/dense.hpp"
#include "fit/algebra/moments.hpp"
#include "fit/collect.hpp"

namespace etlc::fit {
namespace {

/// Returns the same numbers at every call.
Matrix random_matrix(Eigen::Index rows, Eigen::Index columns) {
    std::srand(7);
    return Matrix::Random(rows, columns);
}

double error(const Matrix& found, const Matrix& expected) {
    return (found - expected).norm() / std::max(1.0, expected.norm());
}

TEST(Products, AreSummedInTheOrderOfTheColumns) {
    for (const Eigen::Index rows : {1, 7, 8, 13, 40}) {
        const Matrix columns = random_matrix(rows, 29);
        Matrix found = Matrix::Zero(rows, rows);
        add_products(columns, 0.5, found);
        Matrix in_threads = Matrix::Zero(rows, rows);
        add_products(columns, 0.5, in_threads, 3);
        EXPECT_EQ(in_threads, found) << rows << " rows";
        for (Eigen::Index i = 0; i < rows; ++i)
            for (Eigen::Index j = 0; j <= i; ++j) {
                double sum = 0;
                for (Eigen::Index k = 0; k < columns.cols(); ++k)
                    sum += columns(i, k) * columns(j, k);
                EXPECT_EQ(found(i, j), 0.5 * sum) << rows << " rows, " << i << ", " << j;
            }
    }
}

TEST(SquaredDistance, IsThatOfEveryDimension) {
    for (const std::size_t dimension : {1U, 7U, 8U, 9U, 40U}) {
        std::vector<float> point(dimension);
        Vector mean(static_cast<Eigen::Index>(dimension));
        double expected = 0;
        for (std::size_t i = 0; i < dimension; ++i) {
            point[i] = 3 * static_cast<float>(i) - 20;
            mean(static_cast<Eigen::Index>(i)) = 2 - static_cast<double>(i);
            const double apart = 4 * static_cast<double>(i) - 22;
            expected += apart * apart;  // whole numbers: exact in any order
        }
        EXPECT_EQ(squared_distance(point, mean), expected);
    }
}

TEST(Cholesky, SolvesAndInverts) {
    const Matrix half = random_matrix(100, 300);  // more than two blocks, the last of them short
    const Matrix s = half * half.transpose();
    const auto cholesky = Cholesky::of(s);
    ASSERT_TRUE(cholesky);
    EXPECT_LT(error(s * cholesky->inverse(), Matrix::Identity(100, 100)), 1e-12);
    EXPECT_LT(error(s * cholesky->solve(half.col(0)), half.col(0)), 1e-12);
    const Matrix narrow = half.leftCols(60);
    EXPECT_FALSE(Cholesky::of(narrow * narrow.transpose())) << "60 directions of 100";
}

void expect_eigenpairs(const Matrix& symmetric, Eigen::Index count, const std::string& what) {
    const Eigenpairs found = greatest_eigenpairs(symmetric, count);
    const Vector all = Eigen::SelfAdjointEigenSolver<Matrix>(symmetric).eigenvalues();
    EXPECT_LT(error(found.values, all.reverse().head(count)), 1e-12) << what;
    EXPECT_LT(error(symmetric * found.vectors, found.vectors * found.values.asDiagonal()), 1e-11)
        << what;
    EXPECT_LT(error(found.vectors.transpose() * found.vectors, Matrix::Identity(count, count)),
              1e-12)
        << what;
}

TEST(Eigenvectors, AreOrthogonalWhereEigenvaluesAreEqualToo) {
    const Matrix half = random_matrix(90, 200);
    expect_eigenpairs(half * half.transpose(), 5, "all different");
    expect_eigenpairs(half * half.transpose(), 60, "more than a quarter of them");
    const Matrix basis =
        Eigen::SelfAdjointEigenSolver<Matrix>(half * half.transpose()).eigenvectors();
    Vector values = Vector::Constant(90, 1e-6);
    values.head(12).setConstant(2);
    expect_eigenpairs(basis * values.asDiagonal() * basis.transpose(), 8, "twelve equal ones");
    values.tail(87).setZero();
    expect_eigenpairs(basis * values.asDiagonal() * basis.transpose(), 8, "three directions");
    expect_eigenpairs(Matrix::Identity(90, 90), 8, "no direction before the others");
    expect_eigenpairs(Matrix::Zero(90, 90), 8, "nothing");
}

/// Uses the lower triangle.
Matrix whole(const Matrix& lower) {
    return lower.selfadjointView<Eigen::Lower>();
}

/// Returns the scatter within the classes of these frames, by definition.
Matrix within(const Matrix& frames, const std::vector<std::int8_t>& classes) {
    Matrix result = Matrix::Zero(frames.rows(), frames.rows());
    for (const int c : {0, 1}) {
        Vector mean = Vector::Zero(frames.rows());
        double n = 0;
        for (Eigen::Index i = 0; i < frames.cols(); ++i)
            if (classes[static_cast<std::size_t>(i)] == c) mean += frames.col(i), n += 1;
        if (n == 0) continue;
        for (Eigen::Index i = 0; i < frames.cols(); ++i)
            if (classes[static_cast<std::size_t>(i)] == c)
                result += (frames.col(i) - mean / n) * (frames.col(i) - mean / n).transpose();
    }
    return result;
}

/// Frames in two parts, each longer than a block, collected for two needs at once: one knows all
/// labels, the other only some.
TEST(Moments, OfPartsMergedAreThoseOfAllFrames) {
    const Matrix frames = random_matrix(6, 1500).cast<float>().cast<double>();
    std::vector<std::int8_t> known, partly;
    for (Eigen::Index i = 0; i < frames.cols(); ++i) {
        known.push_back(frames(0, i) > 0.3 ? 1 : 0);
        partly.push_back(i % 5 == 0 ? Blocks::kNone : static_cast<std::int8_t>(i % 2));
    }
    std::vector<Moments> all{Moments(6), Moments(6)};
    for (const auto& [begin, end] : {std::pair<Eigen::Index, Eigen::Index>{0, 700}, {700, 1500}}) {
        Blocks blocks(6, {true, true});
        for (Eigen::Index i = begin; i < end; ++i) {
            const auto at = static_cast<std::size_t>(i);
            std::vector<float> point(6);
            for (Eigen::Index d = 0; d < 6; ++d)
                point[static_cast<std::size_t>(d)] = static_cast<float>(frames(d, i));
            blocks.add(point, {known[at], partly[at]});
        }
        const std::vector<Moments> part = blocks.take();
        Moments::merge({&all[0], &all[1]}, {&part[0], &part[1]});
    }
    EXPECT_EQ(all[0].frames(), 1500U);
    EXPECT_EQ(all[1].frames(), 1200U);
    EXPECT_LT(error(whole(all[0].within()), within(frames, known)), 1e-12);
    EXPECT_LT(error(whole(all[1].within()), within(frames, partly)), 1e-12);
    const Vector direction = frames.col(0);
    EXPECT_NEAR(all[0].within_along(direction), direction.dot(within(frames, known) * direction),
                1e-9);
}

TEST(Moments, ClassesThatDoNotVaryHaveNoVarianceWithin) {
    Blocks blocks(2, {true});
    for (int i = 0; i < 30; ++i) {
        const bool holds = i % 3 == 0;
        blocks.add({holds ? 0.1F : 0.7F, 3.3F}, {static_cast<std::int8_t>(holds ? 1 : 0)});
    }
    const Moments moments = blocks.take().front();
    EXPECT_EQ(whole(moments.within()), Matrix::Zero(2, 2)) << "nor what rounding leaves of one";
    EXPECT_EQ(moments.constants(), 1U) << "the first element differs between the classes";
}

TEST(Clusters, AreThoseThatLieApart) {
    Matrix points = random_matrix(5, 120) * 0.1;
    for (Eigen::Index i = 0; i < points.cols(); ++i) points(i % 3, i) += 10;
    const Points all(points);
    Members every_other;
    for (Eigen::Index i = 0; i < points.cols(); i += 2) every_other.push_back(i);
    const auto centres = k_means(all, every_other, 3);
    ASSERT_TRUE(centres);
    for (Eigen::Index c = 0; c < 3; ++c) {
        Eigen::Index cluster = 0;
        centres->col(c).maxCoeff(&cluster);
        Vector mean = Vector::Zero(5);
        for (const Eigen::Index i : every_other)
            if (i % 3 == cluster) mean += points.col(i) / 20;
        EXPECT_LT(error(centres->col(c), mean), 1e-12);
    }
    for (const std::size_t i : nearest_points(all, every_other, *centres))
        EXPECT_LT(i, every_other.size());
}

TEST(Clusters, TakeDifferentPoints) {
    Matrix points(1, 6);
    points << 4, 4, 4, 5, 5, 1e6;
    const Points all(points);
    const Members members{0, 1, 2, 3, 4, 5};
    EXPECT_TRUE(k_means(all, members, 3));
    EXPECT_FALSE(k_means(all, members, 4)) << "there are three different ones";
    EXPECT_FALSE(k_means(all, {0, 1, 2}, 2));
}

}  // namespace
}  // namespace etlc::fit
