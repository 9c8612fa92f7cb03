// The words of Embedding Temporal Logic. docs/language.md explains them.
//
// Reserved words come first. The contextual words after them (types, units,
// distances, aggregations, functions) are tokens of their own, which the
// parser's rule `name` accepts as names as well.
lexer grammar EtlLexer;

// ---- reserved: declarations

SPEC      : 'spec' ;
RATE      : 'rate' ;
PERIOD    : 'period' ;
CONST     : 'const' ;
INPUT     : 'input' ;
TARGET    : 'target' ;
PREDICATE : 'predicate' ;
TRUTH     : 'truth' ;
LET       : 'let' ;
SLIDING   : 'sliding' ;
MONITOR   : 'monitor' ;

// ---- reserved: values

TRUE       : 'true' ;
FALSE      : 'false' ;
CALIBRATED : 'calibrated' ;
LOAD       : 'load' ;
INF        : 'inf' ;

// ---- reserved: operators of formulas; the word is an exact synonym

IFF          : '<->' | 'iff' ;
IMPLIES      : '->' | 'implies' ;
OR           : '||' | 'or' ;
AND          : '&&' | 'and' ;
NOT          : '!' | 'not' ;
UNTIL        : 'U' | 'until' ;
WEAK_UNTIL   : 'W' | 'weak_until' ;
RELEASE      : 'R' | 'release' ;
SINCE        : 'S' | 'since' ;
NEXT         : 'X' | 'next' ;
EVENTUALLY   : 'F' | 'eventually' ;
ALWAYS       : 'G' | 'always' ;
PREVIOUS     : 'Y' | 'previous' ;
ONCE         : 'O' | 'once' ;
HISTORICALLY : 'H' | 'historically' ;

// ---- contextual: inputs, their types, and what counts where a sample is missing

IN      : 'in' ;
HOLD    : 'hold' ;
MISSING : 'missing' ;
SCALE   : 'scale' ;
STALE   : 'stale' ;
AFTER   : 'after' ;
F32     : 'f32' ;
F16     : 'f16' ;
I8      : 'i8' ;
BOOL    : 'bool' ;

// ---- contextual: monitors that restart

RESTARTABLE : 'restartable' ;
REPEATING   : 'repeating' ;

// ---- contextual: whether a calibration still holds

DRIFT : 'drift' ;

// ---- contextual: operators of formulas

RISE : 'rise' ;
FALL : 'fall' ;
HELD : 'held' ;

// ---- contextual: maps of embeddings, and what is taken or fitted from demonstrations

PROJECTION : 'projection' ;
OFFSET     : 'offset' ;
FITTED     : 'fitted' ;
FRAMES     : 'frames' ;
STRIDE     : 'stride' ;
OF         : 'of' ;
WHERE      : 'where' ;

// ---- contextual: what makes embeddings of images

ENCODER   : 'encoder' ;
BY        : 'by' ;
IMAGES    : 'images' ;
IMAGE     : 'image' ;
DEVIATION : 'deviation' ;
RESIZE    : 'resize' ;
FLIP      : 'flip' ;
CHANNELS  : 'channels' ;
MARGINS   : 'margins' ;
OUTPUT    : 'output' ;
POOL      : 'pool' ;
PREPROCESSOR : 'preprocessor' ;

// ---- contextual: how durations are rounded

DURATIONS : 'durations' ;
UP        : 'up' ;
DOWN      : 'down' ;
NEAREST   : 'nearest' ;

// ---- contextual: units

HERTZ        : 'Hz' ;
MICROSECONDS : 'us' ;
MILLISECONDS : 'ms' ;
SECONDS      : 's' ;
STEPS        : 'steps' | 'step' ;

// ---- contextual: distances, aggregations, functions; `min` is a unit as well

DISTANCE    : 'l2' | 'l2sq' | 'l1' | 'linf' | 'cosine' | 'angular' ;
MAHALANOBIS : 'mahalanobis' ;
MIN         : 'min' ;
MAX         : 'max' ;
MEAN        : 'mean' ;
KTH         : 'kth' ;
ABS         : 'abs' ;
COUNT       : 'count' ;
FRACTION    : 'fraction' ;
SQRT        : 'sqrt' ;

IDENTIFIER : [A-Za-z_] [A-Za-z_0-9]* ;

// ---- numbers and strings: the sign is a token of its own; a
// string is taken as it stands, without escapes

NUMBER : DIGIT+ ('.' DIGIT+)? EXPONENT? ;
STRING : '"' ~["\r\n]* '"' ;

// ---- punctuation

LESS_EQUAL    : '<=' ;
LESS          : '<' ;
GREATER_EQUAL : '>=' ;
GREATER       : '>' ;
EQUAL         : '==' ;
NOT_EQUAL     : '!=' ;
ASSIGN        : '=' ;
PLUS          : '+' ;
MINUS         : '-' ;
TIMES         : '*' ;
DIVIDE        : '/' ;
AT            : '@' ;
LPAREN        : '(' ;
RPAREN        : ')' ;
LBRACKET      : '[' ;
RBRACKET      : ']' ;
COMMA         : ',' ;
COLON         : ':' ;
SEMICOLON     : ';' ;

// ---- what lies between words

BLANKS        : [ \t\r\n\f\u000B]+            -> skip ;
LINE_COMMENT  : '//' ~[\r\n]*                 -> skip ;
BLOCK_COMMENT : '/*' .*? '*/'                 -> skip ;

// ---- mistakes, as tokens, so that messages can name them. An unterminated comment takes the rest
// of the file: were it two characters long, a file full of them would be read over and over.

UNTERMINATED_STRING  : '"' ~["\r\n]* ;
UNTERMINATED_COMMENT : '/*' (~[*] | '*'+ ~[*/])* '*'* ;

MALFORMED_NUMBER
    : DIGIT+ '.'
    | '.' DIGIT+ EXPONENT?
    | DIGIT+ ('.' DIGIT+)? [eE] [+-]?
    | DIGIT+ '.' DIGIT+ EXPONENT? [fF]
    | '0' [xX] [0-9a-fA-F]+
    ;

FOREIGN_OPERATOR
    : '===' | '!==' | '<>' | '=>' | '<=>' | '=<' | '<-->' | '-->'
    | '&' | '|' | '^' | '~' | '%' | '**' | '/\\' | '\\/' | ':='
    ;

UNEXPECTED : . ;

fragment DIGIT    : [0-9] ;
fragment EXPONENT : [eE] [+-]? DIGIT+ ;
