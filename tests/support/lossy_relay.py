"""Hands LCM's datagrams on from one multicast port to another, but for every 13th.

    lossy_relay.py FROM_PORT TO_PORT

Until it is stopped; nothing leaves the computer. A step is about 14 datagrams, so each kind
of message is hit in turn, the marks among them.
"""
import socket
import struct
import sys

GROUP = "239.255.76.67"
LOST = 13


def main():
    from_port, to_port = int(sys.argv[1]), int(sys.argv[2])
    inward = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    inward.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    inward.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
    inward.bind((GROUP, from_port))
    member = struct.pack("4s4s", socket.inet_aton(GROUP), socket.inet_aton("0.0.0.0"))
    inward.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, member)
    outward = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    outward.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
    count = 0
    while True:
        datagram = inward.recv(65536)
        count += 1
        if count % LOST:
            outward.sendto(datagram, (GROUP, to_port))


if __name__ == "__main__":
    main()
