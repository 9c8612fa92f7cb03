#include "reference/prefix.hpp"

#include "reference/clauses.hpp"

namespace etlc::reference {

template class PrefixOf<double>;

}  // namespace etlc::reference
