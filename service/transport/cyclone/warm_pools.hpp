// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/transport/participant.hpp"

namespace meridian::dds {

/// Fills the pool from which Cyclone DDS takes a node for every sample that a writer keeps, so that
/// no later write of this process needs malloc for one. Call it before real-time threads write.
/// About 4 ms and 0.6 MB, once a process; further calls use the same nodes. Throws DdsError.
///
/// The pool (ddsi/q_freelist.h) has four drawers of 256 nodes, common stock in full drawers, and a
/// thread takes from the drawer that its stack address picks. A thread whose drawer and the stock
/// are empty calls malloc, though the other drawers be full: seen where the host stalled one thread
/// in the middle of a write while another wrote, and where receivers' acknowledgements gave nodes
/// back into other drawers than they came from. With more nodes in the process than three drawers
/// and all histories hold together, a drawer and the stock are never empty at once; with as many
/// drawers as full stock needs, giving back never allocates one either.
void warm_pools(Participant& participant);

}  // namespace meridian::dds
