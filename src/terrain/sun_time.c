/* Dates and times as ISO 8601 writes them. */
#include "terrain/sun.h"

#include <ctype.h>

typedef struct Text {
    const char *at;
} Text;

/* Exactly `count` digits. */
static bool take_digits(Text *text, int count, int *out) {
    int value = 0;
    for (int i = 0; i < count; i++) {
        if (!isdigit((unsigned char)text->at[i])) return false;
        value = 10 * value + (text->at[i] - '0');
    }
    text->at += count;
    *out = value;
    return true;
}

static bool take(Text *text, char c) {
    bool is = *text->at == c;
    text->at += is;
    return is;
}

static int month_length(int year, int month) {
    static const int length[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
    bool leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    return length[month - 1] + (month == 2 && leap);
}

/* Days from 0000-03-01 of the Gregorian calendar: years that begin in March end with the day that leap years add. */
static int day_number(int year, int month, int day) {
    int from_march = (month + 9) % 12, y = year - (month < 3) + 400;
    return 365 * y + y / 4 - y / 100 + y / 400 + (153 * from_march + 2) / 5 + day - 1;
}

static bool take_date(Text *text, double *days) {
    int year, month, day;
    if (!take_digits(text, 4, &year) || !take(text, '-') || !take_digits(text, 2, &month) || !take(text, '-') || !take_digits(text, 2, &day)) return false;
    if (month < 1 || month > 12 || day < 1 || day > month_length(year, month)) return false;
    *days = day_number(year, month, day) - day_number(2000, 1, 1) - 0.5;
    return true;
}

/* Seconds with their fraction, 60 being a leap second. */
static bool take_seconds(Text *text, double *seconds) {
    int whole;
    double place = 0.1;
    if (!take_digits(text, 2, &whole) || whole > 60) return false;
    *seconds = whole;
    if (!take(text, '.') && !take(text, ',')) return true;
    if (!isdigit((unsigned char)*text->at)) return false;
    for (; isdigit((unsigned char)*text->at); text->at++, place /= 10) *seconds += place * (*text->at - '0');
    return true;
}

static bool take_time(Text *text, double *days) {
    int hour, minute;
    double second = 0;
    if (!take_digits(text, 2, &hour) || !take(text, ':') || !take_digits(text, 2, &minute)) return false;
    if (take(text, ':') && !take_seconds(text, &second)) return false;
    if (hour > 24 || minute > 59 || (hour == 24 && (minute > 0 || second > 0))) return false;
    *days += (hour * 3600.0 + minute * 60.0 + second) / 86400;
    return true;
}

static bool take_zone(Text *text, double *days) {
    int hour, minute = 0, sign = *text->at == '-' ? -1 : 1;
    if (take(text, 'Z') || *text->at == '\0') return true;
    if (!take(text, '+') && !take(text, '-')) return false;
    if (!take_digits(text, 2, &hour)) return false;
    if ((take(text, ':') || *text->at) && !take_digits(text, 2, &minute)) return false;
    if (hour > 15 || minute > 59) return false;
    *days -= sign * (hour * 60.0 + minute) / 1440;
    return true;
}

bool sun_parse_time(const char *text, double *days, StrBuf *error) {
    Text rest = {text};
    double read;
    bool is = take_date(&rest, &read);
    if (is && (take(&rest, 'T') || take(&rest, ' '))) is = take_time(&rest, &read) && take_zone(&rest, &read);
    if (is && *rest.at == '\0') {
        *days = read;
        return true;
    }
    if (error) strbuf_addf(error, "'%.40s' is no date of the calendar; they are written 2026-06-21, 2026-06-21T10:00Z or 2026-06-21T12:00:30+02:00", text);
    return false;
}
