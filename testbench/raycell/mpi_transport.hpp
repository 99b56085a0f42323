// Ranks as processes that mpirun has started. Nothing of MPI's shows here; without it the program is built
// with mpi_missing.cpp instead.
#pragma once

#include <memory>

#include "pipeline/ranks/rank_exchange.hpp"

namespace raycell {

/// The ranks as they are while one machine runs.
class RankSession : public RankTransport {
  public:
    /// What rank 0 has, for all.
    virtual Bytes broadcast(const Bytes& from_rank_0) = 0;
    /// Ends the session, when all ranks have come here.
    virtual void finish() = 0;
    /// Ends all ranks at once; mpirun's exit code will be `code`.
    [[noreturn]] virtual void abort(int code) = 0;
};

/// Joins the other processes that mpirun started. Throws RanksRefused in a program without MPI.
std::unique_ptr<RankSession> join_ranks();

}  // namespace raycell
