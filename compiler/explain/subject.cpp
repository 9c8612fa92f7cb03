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
    const auto judged_as = [&](Status status) {
        Values values(subject.graph, subject.nodes, subject.observations, subject.last,
                      deciding_end(status), altered);
        const Sourced root = values.at(subject.root, subject.position);
        if (!subject.supports(status, root.key)) status = Status::unknown;
        return Judged{status, std::move(values), root};
    };
    Judged judged = judged_as(Status::satisfied);
    if (judged.status == Status::unknown) judged = judged_as(Status::violated);
    return judged;
}

}  // namespace etlc::explain
