// check_names field|namespace <NAMES: prints those of the names, one per line, that a spec may
// declare.
#include <iostream>
#include <string>

#include "check/names/reserved.hpp"

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const bool is_namespace = std::string(argv[1]) == "namespace";
    for (std::string name; std::getline(std::cin, name);)
        if (!etlc::check::why_forbidden(name, is_namespace)) std::cout << name << '\n';
}
