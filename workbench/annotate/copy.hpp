// A copy of a data set, in which some files are others, or have more columns.
// Takes: the folder of a set. Gives: a folder beside the new name, with all files except those that
// the caller writes into it; then the name. Keeps true: the copy takes its name only when it is
// complete, and a failure leaves nothing of it; the files of the set are not changed; memory is
// that of what is new.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "annotate/extend.hpp"
#include "data/files/file.hpp"
#include "diag/diag.hpp"

namespace etlc::annotate {

class DatasetCopy {
public:
    /// `to`: the new folder; empty: the copy will replace the set. `changed`: the files, by their
    /// paths in the folder, that the caller writes. Videos and images become hard links where the
    /// file system can, and all files of a copy that will replace the set; the others are copied.
    /// `.git` and `.cache`, which git and the Hub use, stay out of a new folder.
    DatasetCopy(std::string from, std::string to, std::set<std::string> changed);
    DatasetCopy(const DatasetCopy&) = delete;
    DatasetCopy& operator=(const DatasetCopy&) = delete;
    ~DatasetCopy();

    /// Copies the other files. Failures are E0901 and name the file.
    std::optional<diag::Failure> fill();
    /// Writes a Parquet file of the set with columns behind its own. A reader has read it before.
    std::optional<diag::Failure> extend(const std::string& file,
                                        const std::vector<NewColumn>& columns);
    /// Writes another file.
    std::optional<diag::Failure> write(const std::string& file, const std::string& bytes);
    /// Gives the copy its name.
    std::optional<diag::Failure> commit();

    std::uint64_t copied() const { return copied_; }
    std::uint64_t linked() const { return linked_; }

private:
    std::string path_of(const std::string& file) const { return part_ + "/" + file; }
    /// Makes the folder of the copy, or clears the one that a killed call left. Throws
    /// fs::filesystem_error.
    std::optional<diag::Failure> begin();
    void take(const std::string& file, const std::string& from);

    std::string from_;
    std::string to_;
    std::string part_;       ///< the copy, until it is complete
    data::Descriptor lock_;  ///< of that folder
    std::set<std::string> changed_;
    bool replaces_ = false;
    std::uint64_t copied_ = 0;
    std::uint64_t linked_ = 0;
};

}  // namespace etlc::annotate
