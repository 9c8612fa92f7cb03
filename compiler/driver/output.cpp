#include "driver/output.hpp"

#include <list>
#include <optional>
#include <string_view>
#include <vector>

#include "data/file.hpp"
#include "plan/stored.hpp"

namespace etlc::driver {

namespace {

/// "monitor.hpp: spec.etl targets/a.npy", as make and ninja read it.
std::string dependency_rule(const std::string& output, const std::string& spec, const std::vector<std::string>& files) {
    const auto escaped = [](const std::string& path) {
        std::string text;
        for (char c : path) {
            if (c == ' ' || c == '#') text += '\\';
            if (c == '$') text += '$';
            text += c;
        }
        return text;
    };
    std::string rule = escaped(output) + ": " + escaped(spec);
    for (const std::string& file : files) rule += " \\\n  " + escaped(file);
    return rule + "\n";
}

/// A file of the output that takes its name only when all others are complete too.
class OutputFile {
public:
    OutputFile(std::string path, diag::Sink& sink) : path_(std::move(path)), sink_(sink) {
        auto file = data::AtomicFile::create(path_ == "-" ? "/dev/stdout" : path_, diag::Code::unwritable_output);
        if (file)
            file_.emplace(std::move(*file));
        else
            report(file.failure());
    }
    /// False, and reported, where it cannot be written.
    bool write(std::string_view bytes) { return file_ && succeeds(file_->write(bytes)); }
    bool commit() { return file_ && succeeds(file_->commit()); }

private:
    bool succeeds(const std::optional<diag::Failure>& failure) {
        if (failure) report(*failure);
        return !failure;
    }
    void report(const diag::Failure& failure) { sink_.report(data::in_file(failure, path_)); }

    std::string path_;
    diag::Sink& sink_;
    std::optional<data::AtomicFile> file_;
};

}  // namespace

void write_output(const OutputPaths& paths, const source::File& spec, const Output& output, diag::Sink& sink) {
    std::list<OutputFile> files;
    const auto add = [&](const std::string& path) -> OutputFile& { return files.emplace_back(path, sink); };
    const plan::Plan& plan = output.compiled.plan;
    bool written = true;
    if (paths.targets_named || !plan.stored.empty()) {
        OutputFile& targets = add(paths.targets);
        written = plan::store(plan, [&](const std::uint8_t* bytes, std::size_t size) {
            return targets.write({reinterpret_cast<const char*>(bytes), size});
        });
    }
    if (!paths.depfile.empty())
        written = written && add(paths.depfile).write(dependency_rule(paths.result, spec.path(), output.dependencies));
    // The result is the last to appear, so that whoever sees the header finds its targets.
    written = written && add(paths.result).write(output.text);
    for (OutputFile& file : files) written = written && file.commit();
}

}  // namespace etlc::driver
