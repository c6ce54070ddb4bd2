/* The floor of polling: one Modbus TCP request a connection and period, spread over the period, with epoll.
   poller PORT CONNECTIONS PERIOD_MS SECONDS REGISTERS: prints the share of a core and the replies. */
#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/epoll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

static double now_s(void) {
    struct timespec at;
    clock_gettime(CLOCK_MONOTONIC, &at);
    return at.tv_sec + at.tv_nsec * 1e-9;
}

static int connected(int port) {
    struct sockaddr_in to = {.sin_family = AF_INET, .sin_port = htons(port)};
    int one = 1, to_device = socket(AF_INET, SOCK_STREAM, 0);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (to_device < 0 || connect(to_device, (struct sockaddr *)&to, sizeof to)) exit(1);
    setsockopt(to_device, IPPROTO_TCP, TCP_NODELAY, &one, sizeof one);
    return to_device;
}

int main(int count, char **given) {
    if (count != 6) return 2;
    int connections = atoi(given[2]), registers = atoi(given[5]), events = epoll_create1(0);
    double period_s = atof(given[3]) / 1000.0, begun_s, until_s;
    long sent = 0, received = 0, wanted = 9 + 2 * registers;
    unsigned char request[12] = {0, 1, 0, 0, 0, 6, 1, 3, 0, 0, 0, registers}, reply[512];
    int *devices = calloc(connections, sizeof *devices);
    struct epoll_event ready[64];
    for (int one = 0; one < connections; one++) {
        struct epoll_event wish = {.events = EPOLLIN};
        wish.data.fd = devices[one] = connected(atoi(given[1]));
        epoll_ctl(events, EPOLL_CTL_ADD, devices[one], &wish);
    }
    begun_s = now_s();
    until_s = begun_s + atof(given[4]);
    while (now_s() < until_s) {
        double due_s = begun_s + sent * period_s / connections, left_s = due_s - now_s();
        if (left_s <= 0) {
            if (write(devices[sent++ % connections], request, sizeof request) != sizeof request) return 1;
            continue;
        }
        int found = epoll_wait(events, ready, 64, (int)(left_s * 1000.0) + 1);
        for (int one = 0; one < found; one++) {
            long got = read(ready[one].data.fd, reply, sizeof reply);
            if (got <= 0) return 1;
            received += got;
        }
    }
    struct rusage used;
    getrusage(RUSAGE_SELF, &used);
    double busy_s = used.ru_utime.tv_sec + used.ru_stime.tv_sec
                    + (used.ru_utime.tv_usec + used.ru_stime.tv_usec) * 1e-6;
    printf("%.6f %ld\n", busy_s / (now_s() - begun_s), received / wanted);
    return 0;
}
