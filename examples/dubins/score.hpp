// Counts how often a verdict agrees with the truth.
#pragma once

namespace demo {

struct Score {
    long true_positives = 0;
    long false_positives = 0;
    long false_negatives = 0;
    long true_negatives = 0;

    void count(bool said, bool is) {
        ++(said ? is ? true_positives : false_positives : is ? false_negatives : true_negatives);
    }

    long total() const {
        return true_positives + false_positives + false_negatives + true_negatives;
    }
    long positives() const { return true_positives + false_negatives; }
    double precision() const { return share(true_positives, true_positives + false_positives); }
    double recall() const { return share(true_positives, positives()); }
    double f1() const {
        return share(2 * true_positives, 2 * true_positives + false_positives + false_negatives);
    }
    double agreement() const { return share(true_positives + true_negatives, total()); }

private:
    /// Returns 0 instead of dividing by zero.
    static double share(long part, long whole) {
        return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
    }
};

}  // namespace demo
