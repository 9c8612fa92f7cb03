#include "explain/subject.hpp"

#include <utility>

#include "etlmon/temporal/shift.hpp"

namespace etlc::explain {

bool Subject::supports(Status status, etlmon::Key key) const {
    return (etlmon::shifted(key, shift) >= 0) == (status == Status::satisfied);
}

End deciding_end(Status status) {
    return status == Status::satisfied ? End::low : End::high;
}

Judged judge(const Subject& subject, const std::optional<Altered>& altered) {
    const auto judged_as = [&](Status status, Reading reading) {
        Values values(subject.graph, subject.nodes, subject.observations, subject.last,
                      deciding_end(status), reading, altered);
        const Sourced root = values.at(subject.root, subject.position);
        if (!subject.supports(status, root.key)) status = Status::unknown;
        return Judged{status, reading, std::move(values), root};
    };
    Judged judged = judged_as(Status::satisfied, Reading::so_far);
    if (judged.status == Status::unknown) judged = judged_as(Status::violated, Reading::so_far);
    if (judged.status == Status::unknown) return judged;
    Judged for_good = judged_as(judged.status, Reading::for_good);
    return for_good.status == judged.status ? for_good : judged;
}

}  // namespace etlc::explain
