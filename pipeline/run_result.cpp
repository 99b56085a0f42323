#include "pipeline/run_result.hpp"

namespace raycell {

const char* name_of(Verdict verdict) {
    switch (verdict) {
        case Verdict::completed:
            return "completed";
        case Verdict::deadlock:
            return "deadlock";
        case Verdict::livelock:
            return "livelock";
        case Verdict::cycle_limit:
            return "cycle_limit";
        case Verdict::capacity:
            return "capacity";
        case Verdict::interrupted:
            return "interrupted";
    }
    return "";
}

}  // namespace raycell
