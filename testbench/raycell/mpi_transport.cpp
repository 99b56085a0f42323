// The only file that uses MPI.
#include "testbench/raycell/mpi_transport.hpp"

#include <mpi.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace raycell {
namespace {

/// Size of a parcel's first message, bytes. Almost all parcels of a cycle fit; of a longer one the rest
/// follows.
constexpr std::size_t first_bytes = 65536;
constexpr std::size_t most_bytes = std::size_t(1) << 30;  ///< MPI counts in ints
enum Tag { tag_whole = 1, tag_begun, tag_rest, tag_size, tag_part };

/// An MPI operation on RankProgress.
void join_progress(void* in, void* in_out, int* count, MPI_Datatype*) {
    for (int i = 0; i < *count; ++i) {
        static_cast<RankProgress*>(in_out)[i].join(static_cast<const RankProgress*>(in)[i]);
    }
}

/// Return codes are not checked, since MPI's own handler ends the run with a message.
class MpiSession : public RankSession {
  public:
    MpiSession() {
        MPI_Init(nullptr, nullptr);
        MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
        MPI_Comm_size(MPI_COMM_WORLD, &count_);
        MPI_Type_contiguous(int(sizeof(RankProgress)), MPI_BYTE, &progress_type_);
        MPI_Type_commit(&progress_type_);
        MPI_Op_create(&join_progress, 1, &join_);
    }

    int rank() const override { return rank_; }
    int count() const override { return count_; }

    void swap(std::vector<Parcel>& parcels) override {
        requests_.resize(2 * parcels.size());
        statuses_.resize(requests_.size());
        for (std::size_t i = 0; i < parcels.size(); ++i) {
            Parcel& parcel = parcels[i];
            if (parcel.in.size() < first_bytes) parcel.in.resize(first_bytes);
            MPI_Irecv(parcel.in.data(), int(first_bytes), MPI_BYTE, parcel.rank, MPI_ANY_TAG, MPI_COMM_WORLD,
                      &requests_[2 * i]);
        }
        for (std::size_t i = 0; i < parcels.size(); ++i) {
            const Bytes& out = *parcels[i].out;
            const bool whole = out.size() <= first_bytes;
            MPI_Isend(out.data(), int(std::min(out.size(), first_bytes)), MPI_BYTE, parcels[i].rank,
                      whole ? tag_whole : tag_begun, MPI_COMM_WORLD, &requests_[2 * i + 1]);
        }
        MPI_Waitall(int(requests_.size()), requests_.data(), statuses_.data());
        bool more = false;
        for (std::size_t i = 0; i < parcels.size(); ++i) {
            int size = 0;
            MPI_Get_count(&statuses_[2 * i], MPI_BYTE, &size);
            parcels[i].size = std::size_t(size);
            more = more || statuses_[2 * i].MPI_TAG == tag_begun || parcels[i].out->size() > first_bytes;
        }
        if (more) swap_rest(parcels);
    }

    RankProgress agree(const RankProgress& mine) override {
        RankProgress all;
        MPI_Allreduce(&mine, &all, 1, progress_type_, join_, MPI_COMM_WORLD);
        return all;
    }

    std::vector<Bytes> gather(const Bytes& mine) override {
        if (rank_ != 0) {
            send(0, mine);
            return {};
        }
        std::vector<Bytes> all = {mine};
        for (int other = 1; other < count_; ++other) all.push_back(receive(other));
        return all;
    }

    std::vector<Bytes> gather_for_all(const Bytes& mine) override {
        ByteWriter gathered;
        for (const Bytes& theirs : gather(mine)) gathered.put_all(theirs);
        const Bytes together = broadcast(gathered.take());
        std::vector<Bytes> all;
        for (ByteReader reader(together); !reader.at_end();) all.push_back(reader.get_all<std::byte>());
        return all;
    }

    Bytes broadcast(const Bytes& from_rank_0) override {
        std::uint64_t size = from_rank_0.size();
        MPI_Bcast(&size, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
        Bytes bytes = from_rank_0;
        bytes.resize(size);
        for (std::size_t at = 0; at < bytes.size(); at += most_bytes) {
            MPI_Bcast(bytes.data() + at, int(std::min(most_bytes, bytes.size() - at)), MPI_BYTE, 0,
                      MPI_COMM_WORLD);
        }
        return bytes;
    }

    void finish() override {
        MPI_Barrier(MPI_COMM_WORLD);
        MPI_Op_free(&join_);
        MPI_Type_free(&progress_type_);
        MPI_Finalize();
    }

    void abort(int code) override {
        MPI_Abort(MPI_COMM_WORLD, code);
        std::abort();  // MPI_Abort() does not return, but is not declared so
    }

  private:
    /// Exchanges what did not fit into the first messages.
    void swap_rest(std::vector<Parcel>& parcels) {
        std::vector<MPI_Request> sent;
        for (const Parcel& parcel : parcels) {
            const Bytes& out = *parcel.out;
            if (out.size() <= first_bytes) continue;
            if (out.size() - first_bytes > most_bytes)
                throw std::length_error("more than 1 GB between two ranks in one cycle");
            sent.emplace_back();
            MPI_Isend(out.data() + first_bytes, int(out.size() - first_bytes), MPI_BYTE, parcel.rank,
                      tag_rest, MPI_COMM_WORLD, &sent.back());
        }
        for (std::size_t i = 0; i < parcels.size(); ++i) {
            Parcel& parcel = parcels[i];
            if (statuses_[2 * i].MPI_TAG != tag_begun) continue;
            MPI_Status status;
            MPI_Probe(parcel.rank, tag_rest, MPI_COMM_WORLD, &status);
            int size = 0;
            MPI_Get_count(&status, MPI_BYTE, &size);
            parcel.size = first_bytes + std::size_t(size);
            if (parcel.in.size() < parcel.size) parcel.in.resize(parcel.size);
            MPI_Recv(parcel.in.data() + first_bytes, size, MPI_BYTE, parcel.rank, tag_rest, MPI_COMM_WORLD,
                     MPI_STATUS_IGNORE);
        }
        MPI_Waitall(int(sent.size()), sent.data(), MPI_STATUSES_IGNORE);
    }

    void send(int to, const Bytes& bytes) {
        const std::uint64_t size = bytes.size();
        MPI_Send(&size, 1, MPI_UINT64_T, to, tag_size, MPI_COMM_WORLD);
        for (std::size_t at = 0; at < bytes.size(); at += most_bytes) {
            MPI_Send(bytes.data() + at, int(std::min(most_bytes, bytes.size() - at)), MPI_BYTE, to, tag_part,
                     MPI_COMM_WORLD);
        }
    }

    Bytes receive(int from) {
        std::uint64_t size = 0;
        MPI_Recv(&size, 1, MPI_UINT64_T, from, tag_size, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        Bytes bytes(size);
        for (std::size_t at = 0; at < bytes.size(); at += most_bytes) {
            MPI_Recv(bytes.data() + at, int(std::min(most_bytes, bytes.size() - at)), MPI_BYTE, from,
                     tag_part, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        }
        return bytes;
    }

    int rank_ = 0;
    int count_ = 1;
    MPI_Datatype progress_type_{};
    MPI_Op join_{};
    std::vector<MPI_Request> requests_;
    std::vector<MPI_Status> statuses_;
};

}  // namespace

std::unique_ptr<RankSession> join_ranks() { return std::make_unique<MpiSession>(); }

}  // namespace raycell
