#include "render/preview.h"

#include <errno.h>
#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum { PACKET_CREATE = 4, PACKET_UPDATE_3 = 6 };
enum { CONNECT_MS = 1000, WAIT_MS = 50, PATIENCE_MS = 800 };

typedef struct TileRect {
    int x0, y0, x1, y1;
} TileRect;

struct Preview {
    int socket;
    atomic_bool dead;     /* the viewer has gone away */
    atomic_bool at_once;  /* nothing more is to be sent */
    pthread_t thread;
    bool threaded;
    pthread_mutex_t lock; /* of what follows */
    pthread_cond_t more;
    TileRect *tiles;
    int tile_count, capacity;
    bool ended;
    /* of the sender */
    const Image *image;
    char *name;
    StrBuf packet;
};

/* ---- addresses ---- */

typedef struct Address {
    char host[256], port[8];
} Address;

static bool parse_address(const char *text, Address *out) {
    const char *colon = strrchr(text, ':');
    if (!colon || colon == text) return false;
    size_t size = (size_t)(colon - text);
    bool bracketed = size > 2 && text[0] == '[' && colon[-1] == ']';
    if (bracketed) text++, size -= 2;
    if (size >= sizeof out->host || (!bracketed && memchr(text, ':', size))) return false;
    memcpy(out->host, text, size);
    out->host[size] = '\0';
    size_t digits = strspn(colon + 1, "0123456789");
    if (digits == 0 || digits > 5 || colon[1 + digits]) return false;
    long port = strtol(colon + 1, NULL, 10);
    memcpy(out->port, colon + 1, digits + 1);
    return port >= 1 && port <= 65535;
}

bool preview_address_valid(const char *address) {
    Address parsed;
    return parse_address(address, &parsed);
}

/* 0, or the number of the error. */
static int finish_connecting(int file) {
    struct pollfd wait = {.fd = file, .events = POLLOUT};
    if (poll(&wait, 1, CONNECT_MS) <= 0) return ETIMEDOUT;
    int number = 0;
    socklen_t size = sizeof number;
    return getsockopt(file, SOL_SOCKET, SO_ERROR, &number, &size) == 0 ? number : errno;
}

static int connect_to(const struct addrinfo *place, int *number) {
    int file = socket(place->ai_family, place->ai_socktype, place->ai_protocol);
    if (file < 0) {
        *number = errno;
        return -1;
    }
    fcntl(file, F_SETFL, fcntl(file, F_GETFL) | O_NONBLOCK);
    fcntl(file, F_SETFD, FD_CLOEXEC);
    *number = connect(file, place->ai_addr, place->ai_addrlen) == 0 ? 0 : errno;
    if (*number == EINPROGRESS) *number = finish_connecting(file);
    if (*number == 0) return file;
    close(file);
    return -1;
}

static int open_socket(const char *address, StrBuf *why) {
    Address parsed;
    struct addrinfo hints = {.ai_family = AF_UNSPEC, .ai_socktype = SOCK_STREAM}, *places = NULL;
    int file = -1, number = 0;
    if (!parse_address(address, &parsed)) {
        if (why) strbuf_adds(why, "it is not HOST:PORT");
        return -1;
    }
    int failure = getaddrinfo(parsed.host, parsed.port, &hints, &places);
    for (const struct addrinfo *p = places; p && file < 0; p = p->ai_next) file = connect_to(p, &number);
    if (places) freeaddrinfo(places);
    if (file < 0 && why) strbuf_addf(why, "no viewer answers (%s)", failure ? gai_strerror(failure) : strerror(number));
    return file;
}

/* ---- packets ---- */

static void add_int(StrBuf *out, uint64_t value, int bytes) {
    for (int k = 0; k < bytes; k++) strbuf_addc(out, (char)(value >> (8 * k) & 0xFF));
}

static void add_text(StrBuf *out, const char *text) {
    strbuf_adds(out, text);
    strbuf_addc(out, '\0');
}

static void add_float(StrBuf *out, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    add_int(out, bits, 4);
}

static int shown_channels(const Image *image) { return image->channels > 3 && strcmp(image->names[3], "A") == 0 ? 4 : 3; }

/* The packet's size comes first, itself included; it is set when the packet is whole. */
static void begin_packet(Preview *p, int type) {
    strbuf_clear(&p->packet);
    add_int(&p->packet, 0, 4);
    add_int(&p->packet, (uint64_t)type, 1);
    add_int(&p->packet, 0, 1); /* leaves the focus where it is */
    add_text(&p->packet, p->name);
}

static void add_channel_names(Preview *p) {
    for (int c = 0; c < shown_channels(p->image); c++) add_text(&p->packet, p->image->names[c]);
}

static void compose_create(Preview *p) {
    begin_packet(p, PACKET_CREATE);
    add_int(&p->packet, (uint64_t)p->image->width, 4);
    add_int(&p->packet, (uint64_t)p->image->height, 4);
    add_int(&p->packet, (uint64_t)shown_channels(p->image), 4);
    add_channel_names(p);
}

static void compose_update(Preview *p, TileRect t) {
    int channels = shown_channels(p->image);
    begin_packet(p, PACKET_UPDATE_3);
    add_int(&p->packet, (uint64_t)channels, 4);
    add_channel_names(p);
    add_int(&p->packet, (uint64_t)t.x0, 4);
    add_int(&p->packet, (uint64_t)t.y0, 4);
    add_int(&p->packet, (uint64_t)(t.x1 - t.x0), 4);
    add_int(&p->packet, (uint64_t)(t.y1 - t.y0), 4);
    for (int c = 0; c < channels; c++) add_int(&p->packet, (uint64_t)c, 8);        /* where each begins, */
    for (int c = 0; c < channels; c++) add_int(&p->packet, (uint64_t)channels, 8); /* and from pixel to pixel */
    for (int y = t.y0; y < t.y1; y++)
        for (int x = t.x0; x < t.x1; x++)
            for (int c = 0; c < channels; c++) add_float(&p->packet, image_pixel(p->image, x, y)[c]);
}

/* ---- the sender ---- */

static bool given_up(const Preview *p) { return p->dead || p->at_once; }

/* Waits until the viewer takes more; gives it up where it takes nothing for long after the picture is done. */
static void wait_for_viewer(Preview *p, int *waited) {
    struct pollfd wait = {.fd = p->socket, .events = POLLOUT};
    poll(&wait, 1, WAIT_MS);
    pthread_mutex_lock(&p->lock);
    *waited = p->ended ? *waited + WAIT_MS : 0;
    pthread_mutex_unlock(&p->lock);
    if (*waited > PATIENCE_MS) p->dead = true;
}

static void send_packet(Preview *p) {
    for (int k = 0; k < 4; k++) p->packet.data[k] = (char)(p->packet.size >> (8 * k) & 0xFF);
    int waited = 0;
    for (size_t sent = 0; sent < p->packet.size && !given_up(p);) {
        ssize_t count = send(p->socket, p->packet.data + sent, p->packet.size - sent, MSG_NOSIGNAL);
        if (count > 0) sent += (size_t)count, waited = 0;
        else if (count < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR) p->dead = true;
        else wait_for_viewer(p, &waited);
    }
}

/* The next tile that is done; false when there will be none any more. */
static bool next_tile(Preview *p, int number, TileRect *out) {
    pthread_mutex_lock(&p->lock);
    while (number == p->tile_count && !p->ended) pthread_cond_wait(&p->more, &p->lock);
    bool found = number < p->tile_count;
    if (found) *out = p->tiles[number];
    pthread_mutex_unlock(&p->lock);
    return found;
}

static void *send_all(void *context) {
    Preview *p = context;
    TileRect tile;
    compose_create(p);
    send_packet(p);
    for (int number = 0; next_tile(p, number, &tile); number++) {
        if (given_up(p)) continue;
        compose_update(p, tile);
        send_packet(p);
    }
    return NULL;
}

/* ---- from outside ---- */

Preview *preview_connect(const char *address, StrBuf *why) {
    int file = open_socket(address, why);
    if (file < 0) return NULL;
    Preview *p = calloc(1, sizeof *p);
    if (!p) {
        close(file);
        if (why) strbuf_adds(why, "out of memory");
        return NULL;
    }
    p->socket = file;
    pthread_mutex_init(&p->lock, NULL);
    pthread_cond_init(&p->more, NULL);
    return p;
}

void preview_begin(Preview *p, const char *name, const Image *image, int tile_count) {
    p->image = image;
    p->name = strdup(name);
    p->tiles = calloc((size_t)tile_count, sizeof *p->tiles);
    p->capacity = p->tiles ? tile_count : 0;
    p->threaded = p->name && p->tiles && pthread_create(&p->thread, NULL, send_all, p) == 0;
    p->dead = p->dead || !p->threaded;
}

void preview_tile(Preview *p, int x0, int y0, int x1, int y1) {
    pthread_mutex_lock(&p->lock);
    if (p->tile_count < p->capacity) p->tiles[p->tile_count++] = (TileRect){x0, y0, x1, y1};
    pthread_cond_signal(&p->more);
    pthread_mutex_unlock(&p->lock);
}

void preview_end(Preview *p, bool at_once) {
    if (!p->threaded) return;
    if (at_once) p->at_once = true;
    pthread_mutex_lock(&p->lock);
    p->ended = true;
    pthread_cond_signal(&p->more);
    pthread_mutex_unlock(&p->lock);
    pthread_join(p->thread, NULL);
    p->threaded = false;
}

void preview_close(Preview *p) {
    if (!p) return;
    preview_end(p, true);
    close(p->socket);
    pthread_cond_destroy(&p->more);
    pthread_mutex_destroy(&p->lock);
    strbuf_free(&p->packet);
    free(p->name);
    free(p->tiles);
    free(p);
}
