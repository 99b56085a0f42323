// In place of mpi_transport.cpp in a program that is built without MPI.
#include "testbench/common/entry.hpp"
#include "testbench/raycell/mpi_transport.hpp"

namespace raycell {

std::unique_ptr<RankSession> join_ranks() {
    throw RanksRefused("started as one of " + std::to_string(launched_ranks().count) +
                       " ranks, but built without MPI; expected one process, or a program built with "
                       "-DRAYCELL_MPI=ON");
}

}  // namespace raycell
